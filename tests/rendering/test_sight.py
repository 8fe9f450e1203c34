"""The lists of what may be seen where: nothing that is hit is missing from them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from minirt.kernel.frame import TILE, camera_ray, tiles
from minirt.kernel.rows import kind_of, read
from minirt.kernel.trace import cell
from minirt.lanes import Vec
from minirt.rendering import sight
from minirt.rendering.packing import Packing
from minirt.scene import Camera, Light, Scene
from minirt.shapes import KINDS
from tests.random_scenes import random_scene
from tests.shapes.examples import hits

WIDTH, HEIGHT = 70, 45  # five tiles by three, the last ones cut


def members(traced: Any, starts: str, table: Any, row: Any, at: int) -> set[int]:
    """The shapes in a list, of all kinds."""
    found: set[int] = set()
    for group in traced.groups:
        ends = getattr(group, starts) if row is None else getattr(group, starts)[row]
        found |= set(table[ends[at] : ends[at + 1]].tolist())
    return found


def seen_rays(traced: Any) -> list[tuple[int, int, float]]:
    """What the rays through all pixels hit: the tile, the shape and the distance, of all shapes that they meet."""
    x, y = (axis.ravel() + 0.5 for axis in np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT)))
    origin, direction = camera_ray(traced.camera, WIDTH, HEIGHT, x, y)
    origin = Vec(*(np.float64(part) for part in (origin.x, origin.y, origin.z)))
    tile = (y // TILE * tiles(WIDTH) + x // TILE).astype(int)
    return [
        (int(tile[i]), index, float(t[i]))
        for index, (hit, t) in enumerate(meets(traced, origin, direction))
        for i in np.flatnonzero(hit)
    ]


def meets(traced: Any, origin: Vec, direction: Vec) -> list[Any]:
    answers = []
    for group, i in traced.places:
        rows = traced.groups[group].rows
        with np.errstate(all="ignore"):
            answers.append(kind_of(rows.dtype.names).intersect(read(rows, i), origin, direction))
    return answers


@pytest.mark.parametrize("seed", range(12))
def test_a_tile_lists_all_that_its_rays_hit(seed: int) -> None:
    traced = Packing().pack(random_scene(seed), WIDTH, HEIGHT)
    lists = [members(traced, "starts", traced.seen, None, at) for at in range(tiles(WIDTH) * tiles(HEIGHT))]
    for tile, shape, t in seen_rays(traced):
        assert shape in lists[tile]
        assert t >= traced.near[shape]


@pytest.mark.parametrize("seed", range(12))
def test_a_cell_of_a_lamp_lists_all_that_is_hit_through_it(seed: int) -> None:
    traced = Packing().pack(random_scene(seed), WIDTH, HEIGHT)
    random = np.random.default_rng(seed)
    directions = random.normal(size=(3, 2000))
    directions[:, :40] = np.round(directions[:, :40])  # along axes and diagonals too
    directions[2, (directions == 0).all(axis=0)] = 1
    directions /= np.linalg.norm(directions, axis=0)
    for lamp, row in enumerate(traced.lights):
        cells = cell(Vec(*directions), traced.grid) if traced.grid > 1 else np.zeros(2000)
        lists = [members(traced, "lamp_starts", traced.lit, lamp, at) for at in range(6 * traced.grid**2)]
        assert 0 <= cells.min() <= cells.max() < 6 * traced.grid**2
        for shape, (hit, t) in enumerate(meets(traced, Vec(*row[:3]), Vec(*directions))):
            assert (t[hit] >= traced.lamp_near[lamp, shape]).all()
            assert all(shape in lists[int(at)] for at in cells[hit])


def test_lists_leave_something_out() -> None:
    traced = Packing().pack(random_scene(3), WIDTH, HEIGHT)
    assert len(traced.seen) > 0
    scene = Scene((Camera((0, 0, 0), (0, 0, 1), 60), Light((0, 9, 0), 1), *scattered()))
    traced = Packing().pack(scene, WIDTH, HEIGHT)
    assert traced.grid > 1
    lists = [members(traced, "starts", traced.seen, None, at) for at in range(tiles(WIDTH) * tiles(HEIGHT))]
    assert np.mean([len(each) for each in lists]) < 0.3 * len(scene.shapes)
    ahead = {index for index, shape in enumerate(scene.shapes) if shape.centre[2] < -2}
    assert not any(each & ahead for each in lists)  # nothing behind the eye


def scattered() -> list[Any]:
    sphere = next(kind for kind in KINDS if kind.element.code == "sp")
    return hits(sphere, 1, 0.3, 8.0, shapes=60, rays=8).shapes


@pytest.mark.parametrize("shapes", [1, 8, 9, 200, 2_000, 10_000])
def test_more_shapes_more_cells(shapes: int) -> None:
    assert sight.grid_for(shapes) >= sight.grid_for(max(1, shapes // 2))
    assert (sight.grid_for(shapes) == 1) == (shapes <= 8)


@pytest.mark.parametrize("grid", [2, 16])
def test_a_direction_lies_in_the_cell_that_its_face_row_and_column_say(grid: int) -> None:
    # Through the middle of each cell, by the frames of the faces.
    slopes = (2 * np.arange(grid) + 1) / grid - 1
    expected = 0
    for right, up, forward in sight.FACES:
        for down in slopes:
            for across in slopes:
                direction = forward + across * right + down * up
                assert cell(Vec(*map(np.float64, direction)), grid) == expected
                expected += 1
