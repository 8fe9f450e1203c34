"""Mirrors and glass, where the answer is known: the kernel as it stands, interpreted."""

from __future__ import annotations

from math import asin, cos, degrees, radians, sin

import numpy as np
import pytest

from minirt.kernel.shading.whitted import MIN_WEIGHT
from minirt.materials import Glass
from minirt.rendering.packing.features import DEPTH
from minirt.scene import Ambient, Background, Camera, Scene
from minirt.shapes import Shape
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import Array, interpreted

WHITE, RED, GREY = (255, 255, 255), (255, 0, 0), (102, 102, 102)
LIGHT = Ambient(1.0, WHITE)
SKY = Background((51, 102, 204))
AHEAD = Camera((0, 0, -5), (0, 0, 1), 40)


def light(*elements: Shape | Camera | Ambient | Background, depth: int = DEPTH) -> Array:
    """The light of a small picture, (4, 4, 3)."""
    return interpreted(Scene(elements), 4, 4, depth=depth)[1]


def test_a_perfect_mirror_shows_the_sky() -> None:
    mirror = Plane((0, 0, 0), (0, 0, -1), RED, mirror=1.0)
    assert np.allclose(light(LIGHT, AHEAD, SKY, mirror), [0.2, 0.4, 0.8], rtol=1e-15)


def test_a_mirror_shows_its_share() -> None:
    mirror = Plane((0, 0, 0), (0, 0, -1), RED, mirror=0.25)
    assert np.allclose(light(LIGHT, AHEAD, SKY, mirror), [0.75 + 0.05, 0.1, 0.2], rtol=1e-15)


def test_between_two_mirrors() -> None:
    # Seen along the normals: every mirror shows half of its own light and half of what the other one shows.
    ends = [Plane((0, 0, z), (0, 0, 1), GREY, mirror=0.5) for z in (-6, 6)]
    for depth in (0, 1, 2, 5):
        right = 0.4 * sum(0.5**i * 0.5 for i in range(depth + 1)) if depth else 0.4
        assert np.allclose(light(LIGHT, AHEAD, *ends, depth=depth), right, rtol=1e-13)
    deep = light(LIGHT, AHEAD, *ends, depth=32)
    assert np.allclose(deep, 0.4, atol=2 * MIN_WEIGHT)
    assert (deep < 0.4).all()  # what is left below the cut-off is not followed


def test_glass_that_does_not_bend_light_cannot_be_seen() -> None:
    ball = Sphere((0.3, 0.2, 0), 2, RED, glass=Glass(1.0))
    behind = Sphere((0.1, 0, 8), 3, (10, 200, 30))
    assert np.allclose(light(LIGHT, AHEAD, SKY, ball, behind), light(LIGHT, AHEAD, SKY, behind), rtol=1e-12)


def aimed(angle: float) -> Camera:
    """A camera at a point of height 1, the middle of whose picture meets the floor that many degrees from its
    normal, in the origin."""
    way = sin(radians(angle)), -cos(radians(angle)), 0.0
    return Camera((-way[0] / -way[1], 1.0, 0.0), way, 1e-4)


def target(angle: float, above: bool) -> Sphere:
    """A small ball that a ray meets which leaves the origin with that angle to the normal."""
    height = cos(radians(angle)) * (1 if above else -1)
    return Sphere((3 * sin(radians(angle)), 3 * height, 0), 0.02, RED)


@pytest.mark.parametrize("ior", [1.0, 1.33, 1.5, 2.42])
@pytest.mark.parametrize("angle", [0.0, 10.0, 45.0, 80.0])
def test_light_is_bent_by_the_law_of_snell(ior: float, angle: float) -> None:
    floor = Plane((0, 0, 0), (0, 1, 0), WHITE, glass=Glass(ior))
    found = target(degrees(asin(sin(radians(angle)) / ior)), above=False)
    assert np.allclose(light(LIGHT, aimed(angle), floor, found), [1, 0, 0], atol=1e-12)
    if ior > 1 and angle:
        assert not light(LIGHT, aimed(angle), floor, target(angle, above=False)).any()  # straight on


@pytest.mark.parametrize("angle", [5.0, 20.0, 41.0])
def test_on_the_way_out_it_is_bent_away_from_the_normal(angle: float) -> None:
    floor = Plane((0, 0, 0), (0, -1, 0), WHITE, glass=Glass(1.5))  # its inside is above
    found = target(degrees(asin(1.5 * sin(radians(angle)))), above=False)
    assert np.allclose(light(LIGHT, aimed(angle), floor, found), [1, 0, 0], atol=1e-12)


@pytest.mark.parametrize("angle", [42.0, 60.0, 85.0])
def test_beyond_the_critical_angle_all_is_reflected(angle: float) -> None:
    floor = Plane((0, 0, 0), (0, -1, 0), WHITE, glass=Glass(1.5))  # the angle is asin(1 / 1.5), 41.8 degrees
    assert np.allclose(light(LIGHT, SKY, aimed(angle), floor, target(angle, above=True)), [1, 0, 0], atol=1e-12)


def test_glass_shows_its_share() -> None:
    pane = Plane((0, 0, 0), (0, 0, -1), GREY, glass=Glass(1.5, 0.5), mirror=0.25)
    assert np.allclose(light(LIGHT, AHEAD, SKY, pane), 0.25 * 0.4 + 0.75 * np.array([0.2, 0.4, 0.8]), rtol=1e-12)


def test_shares_of_more_than_all_are_made_smaller_alike() -> None:
    pane = Plane((0, 0, 0), (0, 0, -1), GREY, glass=Glass(1.5, 1.0), mirror=1.0)
    assert np.allclose(light(LIGHT, AHEAD, SKY, pane), [0.2, 0.4, 0.8], rtol=1e-12)


def test_without_bounces_a_mirror_is_a_plain_surface() -> None:
    mirror = Plane((0, 0, 0), (0, 0, -1), RED, mirror=1.0)
    assert np.array_equal(light(LIGHT, AHEAD, SKY, mirror, depth=0)[..., 0], np.ones((4, 4)))
