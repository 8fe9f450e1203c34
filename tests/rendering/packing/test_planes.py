"""Culling of infinite planes: they are in no cell that cannot meet them, and in light buffers only to occlude."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from minirt.kernel.pixels import TILE
from minirt.rendering.packing import lights
from minirt.rendering.packing.lights import signed_heights
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.renderer import Renderer
from minirt.rendering.scene_packing import Packing
from minirt.scene import Camera, FurtherLight, Light, Scene
from minirt.shapes import Plane, Sphere
from tests.kernel.pictures import ALL, linear
from tests.random_scenes import random_scene

GREY = (128, 128, 128)
FLOOR = Plane((0, -1, 0), (0, 1, 0), GREY)


def tiles_of_plane(scene: Scene, across: int = 20, down: int = 10) -> np.ndarray:
    """Whether the only shape of a scene is listed in each tile."""
    arrays = Packing().pack(scene, across * TILE, down * TILE)
    return np.diff(arrays.groups[0].tile_starts[: across * down + 1]).reshape(down, across) > 0


@pytest.mark.parametrize("side", [1, -1])
def test_tiles_above_the_horizon_are_empty(side: int) -> None:
    # The horizon is the centre line of the picture; a pixel of margin reaches one row of tiles further.
    floor = FLOOR.replace(normal=(0, side, 0))
    listed = tiles_of_plane(Scene((Camera((0, 0, 0), (0, 0, 1), 90), floor)))
    assert listed[5:].all()
    assert not listed[:4].any()
    ceiling = FLOOR.replace(point=(0, 1, 0))
    listed = tiles_of_plane(Scene((Camera((0, 0, 0), (0, 0, 1), 90), ceiling)))
    assert listed[:5].all()
    assert not listed[6:].any()


@pytest.mark.parametrize("size", [1.0, 1e8])
def test_a_point_on_a_plane_within_rounding_has_height_zero(size: float) -> None:
    random = np.random.default_rng(1)
    for _ in range(50):
        point, way = size * random.normal(size=3), random.normal(size=3)
        plane = Plane(tuple(point), tuple(way / np.abs(way).max()), GREY)
        shapes = ShapeArrays()
        shapes.update((plane,))
        along = np.cross(plane.normal, random.normal(size=3))
        above = np.array(plane.normal)
        assert signed_heights(shapes.planes, point + size * along)[0] == 0
        assert signed_heights(shapes.planes, point + size * (along + above))[0] == pytest.approx(size, rel=1e-6)
        assert signed_heights(shapes.planes, point + size * (along - above))[0] == pytest.approx(-size, rel=1e-6)


def lit_cells(scene: Scene) -> list[int]:
    """The number of cells of each light that list a plane."""
    arrays = Packing().pack(scene, 64, 48)
    kind = [type(shape) for shape in scene.shapes].index(Plane)
    starts = arrays.groups[arrays.slots[kind, 0]].light_starts
    return [
        int((np.diff(each) > 0).sum()) if arrays.light_buffer_cells > 1 else int(each[1] - each[0]) for each in starts
    ]


@pytest.mark.parametrize("balls", [1, 20])
def test_a_plane_is_in_the_light_buffers_of_lights_behind_it(balls: int) -> None:
    eye, above, below = Camera((0, 0, -9), (0, 0, 1), 60), Light((0, 5, 0), 1), FurtherLight((0, -5, 0), 1)
    on = FurtherLight((7, -1, 0), 1)
    shapes = [FLOOR, *(Sphere((i, 0, 0), 1, GREY) for i in range(balls))]
    everything = 6 * 16 * 16 if balls > 8 else 1
    first, second, third = lit_cells(Scene((eye, above, below, on, *shapes)))
    assert first == 0
    assert third == everything
    # From below, the plane is in the upper half of the directions.
    assert second == 1 if balls == 1 else everything / 2 <= second <= everything / 2 + 4 * 2 * 16
    first, second, third = lit_cells(Scene((eye.replace(position=(0, -3, -9)), above, below, on, *shapes)))
    assert (second, third) == (0, everything)
    assert first > 0


def test_light_buffers_follow_an_eye_that_moves_through_a_plane() -> None:
    packing = Packing()
    for height in (0, -2, 0):
        scene = Scene((Camera((0, height, -9), (0, 0, 1), 60), Light((0, 5, 0), 1), FLOOR, Sphere((0, 0, 0), 1, GREY)))
        arrays = packing.pack(scene, 64, 48)
        assert (0 in arrays.light_shapes) == (height < -1)


SEEDS = [seed for seed in range(60) if any(shape.infinite_plane() for shape in random_scene(seed).shapes)]


def test_pictures_are_the_same_without_culling_of_planes(monkeypatch: pytest.MonkeyPatch) -> None:
    scenes = [ALL, *map(random_scene, SEEDS)]
    pictures = [linear(scene, 60, 40, renderer=Renderer(1)) for scene in scenes]
    dropped = []

    original = lights.never_occludes

    def none(shapes: Any, eye: Any, light: Any, radius: float) -> np.ndarray:
        dropped.append(original(shapes, eye, light, radius).any())
        return np.zeros(len(shapes.planes), bool)

    monkeypatch.setattr(lights, "never_occludes", none)
    for scene, picture in zip(scenes, pictures, strict=True):
        assert np.array_equal(linear(scene, 60, 40, renderer=Renderer(1)), picture)
    assert 0.2 < np.mean(dropped) < 0.95
