"""Rectangles of a larger picture: the same bits as a crop of the whole, at the cost of the rectangle."""

from __future__ import annotations

from math import asin, atan, hypot, tan
from typing import Any

import numpy as np
import pytest

import minirt
from minirt.kernel.frame import tile_count
from minirt.rendering.packing import camera
from minirt.rendering.packing.camera import Crop
from minirt.rendering.scene_packing import Packing
from minirt.scene import Ambient, Background, Camera, Scene
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import EVERY, WHITE
from tests.rendering.test_apertures import soft_scene

SIZE = WIDTH, HEIGHT = 203, 77
REGIONS = ((0, 0, *SIZE), (37, 21, 60, 50), (16, 32, 16, 16), (190, 66, 13, 11), (102, 40, 1, 1))
SKY = Scene((Camera((0, 0, 0), (0.1, 0.2, 1), 70), Background(paint=(200, 100, 50))))


def crops(scene: Scene, region: tuple[int, int, int, int], **settings: Any) -> list[tuple[np.ndarray, np.ndarray]]:
    """Levels and light of a region, rendered alone and cut out of the whole picture."""
    x, y, width, height = region
    alone, whole = (minirt.render(scene, *SIZE, region=each, **settings) for each in (region, None))
    inside = slice(y, y + height), slice(x, x + width)
    return [(alone.array, alone.linear), (whole.array[inside], whole.linear[inside])]


@pytest.mark.parametrize(
    ("scene", "settings"),
    [
        *((EVERY, each) for each in ({}, {"samples": 5}, {"dither": True}, {"precision": "single"}, {"depth": 0})),
        *((EVERY.replace(EVERY.camera, tone=tone), {"dither": True}) for tone in ("srgb", "filmic")),
        *((soft_scene(0.5), {"samples": samples}) for samples in (1, 4, 100)),
        *((scene, {}) for scene in (SKY, Scene((SKY.camera,)))),
    ],
)
def test_a_region_is_a_crop_of_the_picture(scene: Scene, settings: dict[str, Any]) -> None:
    for region in REGIONS:
        for alone, cut in zip(*crops(scene, region, **settings), strict=True):
            assert np.array_equal(alone, cut), region


def test_a_region_takes_the_tiles_that_it_touches_and_no_others() -> None:
    cut = camera.cut_for((37, 21, 60, 50), *SIZE)
    assert (cut.crop, cut.shape) == (Crop(*SIZE, 32, 16), (55, 65))
    group, *_ = Packing().pack(EVERY, *cut.shape[::-1], cut.crop).groups
    assert len(group.tile_starts) == tile_count(55) * tile_count(65) + 1


def test_a_region_of_a_huge_picture_shows_what_its_rays_hit() -> None:
    width, height, centre = 100_000, 20_000, (-3.0, 0.01, 10.0)
    slope = tan(atan(0.3) + asin(1 / hypot(3, 10)))  # of the outer edge of the ball, which is right of the middle
    region = round((1 + slope) / 2 * width) - 20, 9_990, 40, 30
    ball, eye = Sphere(centre, 2.0, WHITE), Camera((0, 0, 0), (0, 0, 1), 90)
    shown = minirt.render(Scene((Ambient(1.0, WHITE), eye, ball)), width, height, region=region)
    y, x = np.mgrid[: region[3], : region[2]]
    right = 2 * (region[0] + x + 0.5) / width - 1  # slopes of the rays; x points to the left
    up = (1 - 2 * (region[1] + y + 0.5) / height) * height / width
    rays = np.stack([-right, up, np.ones_like(right)], axis=-1)
    hit = np.linalg.norm(np.cross(rays, centre), axis=-1) < np.linalg.norm(rays, axis=-1)
    assert 0.1 < hit.mean() < 0.9
    assert np.array_equal(shown.linear[..., 0] == 1.0, hit)


def test_the_error_of_a_region_is_that_of_its_own_pixels() -> None:
    region = (48, 16, 96, 48)
    found = minirt.render(EVERY, *SIZE, samples="auto", error=0.004, region=region)
    exact = minirt.render(EVERY, *SIZE, samples=400, region=region)
    assert found.reached
    assert found.reached.is_reached
    clamped = np.minimum(found.linear, 1.0) - np.minimum(exact.linear, 1.0)
    assert found.array.shape == (48, 96, 3)
    assert np.sqrt(np.square(clamped).mean()) < 1.5 * 0.004


@pytest.mark.parametrize(
    ("region", "problem"),
    [
        ((0, 0, 0, 5), "a region has at least 1x1 pixels, got 0x5"),
        ((-1, 0, 5, 5), "region -1,0,5,5 does not lie in the picture of 203x77 pixels"),
        ((200, 0, 4, 5), "region 200,0,4,5 does not lie in the picture"),
        ((0, 77, 1, 1), "does not lie"),
    ],
)
def test_a_region_beyond_the_picture_is_an_error(region: tuple[int, int, int, int], problem: str) -> None:
    with pytest.raises(minirt.RenderError, match=problem):
        minirt.render(EVERY, *SIZE, region=region)
