"""Work that the report says was left out changes no bit of the picture."""

from __future__ import annotations

import numpy as np

from minirt.rendering.notes import kernel_notes
from minirt.rendering.scene_packing import Packing
from minirt.report.measurements.settings import brute_force
from minirt.scene import FurtherLight, Scene
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import ALL, AMBIENT, EYE, LAMP, SHAPES, linear

GREY = (128, 128, 128)


def notes(scene: Scene) -> list[str]:
    packing = Packing()
    packing.pack(scene, 60, 40)
    return packing.notes


def test_lights_of_no_brightness() -> None:
    off, black = FurtherLight((3, 3, -3), 0.0, (255, 255, 255)), FurtherLight((1, 5, 0), 0.7, (0, 0, 0))
    dark = Scene((*ALL.elements, off, black))
    assert {"light 3 has brightness 0", "light 4 is black"} <= set(notes(dark))
    assert np.array_equal(linear(dark, 60, 40), linear(ALL, 60, 40))


def test_planes_that_hide_nothing() -> None:
    said = notes(ALL)
    assert "plane 1 hides nothing from light 1" in said
    assert "plane 2 hides nothing from light 1" in said
    assert np.array_equal(linear(ALL, 60, 40, 1, brute_force(1)), linear(ALL, 60, 40))  # which tries them


def test_shape_types_that_the_scene_lacks() -> None:
    balls = Scene((AMBIENT, EYE, LAMP, *(shape for shape in SHAPES if isinstance(shape, Sphere))))
    assert any("planes, cylinders" in note for note in kernel_notes(balls, generic=None, compiling=False))
    behind = Cylinder((0, 0, -900), (0, 1, 0), 1, 1, GREY), Plane((0, 0, -901), (0, 0, 1), GREY)
    more = Scene((*balls.elements, *behind))
    named, *without = kernel_notes(more, generic=None, compiling=False)
    assert "planes" in named
    assert not any("planes" in note for note in without)
    assert np.array_equal(linear(more, 60, 40), linear(balls, 60, 40))
