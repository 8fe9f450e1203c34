"""Packing of scenes: the arrays are those of the scene, and an edit packs only what it changes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from minirt.kernel.scene_arrays import read
from minirt.materials import Checker
from minirt.rendering.packing import shape_arrays
from minirt.rendering.scene_packing import Packing
from minirt.scene import Ambient, FurtherLight, Light, Scene
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import ALL, EYE, SHAPES


@pytest.fixture
def packed(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The shapes that were packed so far."""
    done: list[Any] = []
    monkeypatch.setattr(
        shape_arrays, "packed_rows", lambda new, numbers=shape_arrays.packed_rows: done.extend(new) or numbers(new)
    )
    return done


def assert_same(arrays: Any, scene: Scene) -> None:
    """Assert that arrays equal those of a fresh packing."""
    fresh = Packing().pack(scene, 24, 16)
    for name, value in zip(fresh._fields, fresh, strict=True):
        if name != "groups":
            assert np.array_equal(getattr(arrays, name), value), name
    for group, expected in zip(arrays.groups, fresh.groups, strict=True):
        assert all(np.array_equal(part, right) for part, right in zip(group, expected, strict=True))


def test_the_arrays_have_the_numbers_of_the_scene() -> None:
    blue = (0, 51, 255)
    lights = Light((1, 2, 3), 0.5, blue), FurtherLight((0, 0, 0), 0.0), FurtherLight((4, 5, 6), 1.0, (0, 0, 0))
    ball, wall = Sphere((1, 2, 3), 4, (255, 0, 51)), Plane((7, -9, 2), (0, 1, 0), blue)
    arrays = Packing().pack(Scene((Ambient(0.5, blue), EYE, *lights, wall, ball)), 24, 16)
    assert arrays.ambient.tolist() == [0, 0.1, 0.5]
    assert arrays.lights.tolist() == [[1, 2, 3, 0, 0.1, 0.5]]  # lights that are off or black are left out
    assert arrays.colours_and_extents.tolist() == [[0, 0.2, 1, 9], [1, 0, 0.2, 5]]
    assert arrays.slots.tolist() == [[1, 0], [0, 0]]  # kinds in the order of the registry
    ball_again = read(arrays.groups[0].rows, 0)
    assert (ball_again.centre.x, ball_again.centre.y, ball_again.centre.z, ball_again.radius) == (1, 2, 3, 2)


def test_a_scene_may_have_no_ambient_light_and_no_lights() -> None:
    arrays = Packing().pack(Scene((EYE, *SHAPES)), 24, 16)
    assert arrays.ambient.tolist() == [0, 0, 0]
    assert arrays.lights.shape == (0, 6)
    assert arrays.light_tolerances.shape == (0,)
    assert arrays.light_cones.shape == (0, len(SHAPES), 5)
    assert len(arrays.light_shapes) == 0
    assert all(group.light_starts.shape == (0, 1) for group in arrays.groups)


def test_an_edit_packs_again_only_what_it_changed(packed: list[Any]) -> None:
    packing = Packing()
    packing.pack(ALL, 24, 16)
    assert len(packed) == len(SHAPES)
    packed.clear()

    moved = ALL.replace(ALL.spheres[1], centre=(9, 9, 9))
    packing.pack(moved, 24, 16)
    assert [repr(each) for each in packed] == [repr(moved.spheres[1].pack())]
    packed.clear()
    packing.pack(moved, 24, 16)
    packing.pack(moved.replace(moved.camera, fov=30), 24, 16)
    packing.pack(moved.replace(moved.lights[0], brightness=0.1), 30, 20)
    assert packed == []
    packing.pack(ALL, 24, 16)
    assert [repr(each) for each in packed] == [repr(ALL.spheres[1].pack())]


@pytest.mark.parametrize(
    "edit",
    [
        lambda s: s.replace(s.spheres[0], diameter=1),
        lambda s: s.replace(s.planes[0], colour=(1, 2, 3)),
        lambda s: s.replace(s.cylinders[1], axis=(0, 1, 0)),
        lambda s: s.replace(s.lights[1], position=(9, 9, 9)),
        lambda s: s.replace(s.lights[0], brightness=0),
        lambda s: s.replace(s.camera, position=(2, 3, -8)),
        lambda s: s.replace(s.spheres[0], Cylinder((0, 0, 0), (0, 1, 0), 1, 1, (255, 0, 0))),
        lambda s: Scene(item for item in s.items if item is not s.spheres[0]),
        lambda s: Scene((*s.items, Sphere((0, 1, 0), 1, (9, 9, 9)))),
        lambda s: Scene(item for item in s.items if item not in s.planes),
        lambda s: Scene((*s.items[:4], *reversed(s.items[4:]))),
        lambda s: Scene(s.items[:4]),
    ],
)
def test_after_an_edit_the_arrays_are_those_of_the_new_scene(edit: Any) -> None:
    packing = Packing()
    for scene in (ALL, edit(ALL), ALL):
        if scene.shapes:
            assert_same(packing.pack(scene, 24, 16), scene)


def test_using_the_arrays_of_another_scene_does_no_harm() -> None:
    edited = ALL.replace(ALL.spheres[0], centre=(0, 3, 2))
    packing = Packing()
    for scene, other in ((ALL, edited), (edited, ALL), (ALL, edited)):
        packing.pack(scene, 24, 16)
        assert packing.shape_arrays_for(other.shapes).shapes == other.shapes
        assert packing.notes == []
        assert_same(packing.pack(other, 24, 16), other)
        packing.shape_arrays_for(scene.shapes)
        assert_same(packing.pack(other, 24, 16), other)


def test_single_precision_draws_checkers_but_no_pictures(tmp_path: Path) -> None:
    Image.new("RGB", (2, 2), (9, 9, 9)).save(tmp_path / "grey.png")
    ball = Sphere((0, 0, 5), 2, (1, 2, 3))
    for shape, number in (
        (ball.replace(checker=Checker(1, (4, 5, 6))), np.float32),
        (ball.replace(texture="grey.png"), np.float64),
    ):
        packing = Packing(precision="single")
        assert packing.pack(Scene((EYE, shape), tmp_path / "scene.rt"), 24, 16).camera.dtype == number
        assert any("double precision" in each for each in packing.notes) is (number is np.float64)
