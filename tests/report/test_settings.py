"""Brute force tries every shape for every ray and gives the same picture, bit for bit."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.errors import RenderError
from minirt.kernel.bvh_nodes import NODE, REFERENCES
from minirt.rendering.notes import kernel_notes
from minirt.rendering.scene_packing import Packing
from minirt.report.settings import ChangedPacking, brute_force, without_boxes, without_light_buffers, without_tiles
from minirt.scene import FurtherLight, Scene
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import ALL, AMBIENT, EYE, LAMP, SHAPES, linear
from tests.random_scenes import random_scene

WIDTH, HEIGHT = 70, 40  # 5 x 3 tiles


@pytest.mark.parametrize("scene", [ALL, Scene((AMBIENT, EYE, *SHAPES)), *map(random_scene, range(1, 6))])
def test_the_picture_is_the_same(scene: Scene) -> None:
    brute = linear(scene, WIDTH, HEIGHT, 3, brute_force(2))
    assert np.array_equal(brute, linear(scene, WIDTH, HEIGHT, 3))


def test_every_tile_and_every_light_has_every_shape() -> None:
    traced = ChangedPacking(without_tiles, without_light_buffers).pack(ALL, WIDTH, HEIGHT)
    for kind, group in enumerate(traced.groups):
        expected = np.flatnonzero(traced.slots[:, 0] == kind).tolist()
        assert len(group.tile_starts) == 15 + 1
        for a, b in zip(group.tile_starts, group.tile_starts[1:], strict=False):
            assert sorted(traced.tile_shapes[a:b]) == expected
        assert len(group.light_starts) == 2
        for a, b in group.light_starts:
            assert sorted(traced.light_shapes[a:b]) == expected
    assert traced.light_buffer_cells == 1
    assert (traced.cones == [0, 0, 0, -2, 0]).all()  # no cone and no distance keeps a shape from being tried
    assert (traced.light_cones == [0, 0, 0, -2, 0]).all()
    assert len(Packing().pack(ALL, WIDTH, HEIGHT).tile_shapes) < len(traced.tile_shapes)


def test_lists_that_would_fill_the_memory_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("minirt.report.settings.MOST", 15 * len(ALL.shapes))
    packing = ChangedPacking(without_tiles)
    packing.pack(ALL, WIDTH, HEIGHT)
    with pytest.raises(RenderError, match="6 shapes in each of 18 tiles are too many"):
        packing.pack(ALL, WIDTH + 16, HEIGHT)


def test_every_ray_visits_every_leaf_of_the_tree() -> None:
    mirrors = ALL.replace(ALL.shapes[1], mirror=0.7).replace(ALL.shapes[0], mirror=0.4)
    tree, wide = (packing.pack(mirrors, WIDTH, HEIGHT).bvh for packing in (Packing(), ChangedPacking(without_boxes)))
    boxes, open_boxes = (each.nodes.reshape(-1, NODE)[:, :REFERENCES] for each in (tree, wide))
    used = (boxes[:, : REFERENCES // 2] <= boxes[:, REFERENCES // 2 :]).sum()
    assert 0 < used == np.isneginf(open_boxes[:, : REFERENCES // 2]).sum()
    assert np.array_equal(tree.nodes.reshape(-1, NODE)[:, REFERENCES:], wide.nodes.reshape(-1, NODE)[:, REFERENCES:])
    brute = linear(mirrors, WIDTH, HEIGHT, 1, brute_force(1))
    assert np.array_equal(brute, linear(mirrors, WIDTH, HEIGHT))


# Work that the report says was left out changes no bit of the picture.


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


def test_shape_types_that_the_scene_lacks() -> None:
    balls = Scene((AMBIENT, EYE, LAMP, *(shape for shape in SHAPES if isinstance(shape, Sphere))))
    assert any("planes, cylinders" in note for note in kernel_notes(balls, generic=None, compiling=False))
    behind = Cylinder((0, 0, -900), (0, 1, 0), 1, 1, GREY), Plane((0, 0, -901), (0, 0, 1), GREY)
    more = Scene((*balls.elements, *behind))
    named, *without = kernel_notes(more, generic=None, compiling=False)
    assert "planes" in named
    assert not any("planes" in note for note in without)
    assert np.array_equal(linear(more, 60, 40), linear(balls, 60, 40))
