"""Reflection and refraction by the interpreted kernel, in scenes with known radiance."""

from __future__ import annotations

from math import asin, cos, degrees, radians, sin, sqrt

import numpy as np
import pytest
from mpmath import mp, mpf

from minirt.kernel.shading.surfaces import reflectance
from minirt.kernel.shading.whitted import MIN_WEIGHT
from minirt.materials import Glass, Mirror
from minirt.rendering.packing.features import DEPTH
from minirt.scene import Ambient, Background, Camera, Scene
from minirt.shapes import Plane, Shape, Sphere
from tests.kernel.pictures import Array, interpreted

WHITE, RED, GREY = (255, 255, 255), (255, 0, 0), (102, 102, 102)
LIGHT = Ambient(1.0, WHITE)
SKY = Background((51, 102, 204))
AHEAD = Camera((0, 0, -5), (0, 0, 1), 40)


def light(*elements: Shape | Camera | Ambient | Background, depth: int = DEPTH) -> Array:
    """Render the linear light of a small picture, (4, 4, 3)."""
    return interpreted(Scene(elements), 4, 4, depth=depth)[1]


@pytest.mark.parametrize("share", [1.0, 0.25])
def test_a_mirror_reflects_its_share(share: float) -> None:
    mirror = Plane((0, 0, 0), (0, 0, -1), RED, mirror=share)
    expected = np.array([1 - share, 0, 0]) + share * np.array([0.2, 0.4, 0.8])
    assert np.allclose(light(LIGHT, AHEAD, SKY, mirror), expected, rtol=1e-15)


def test_two_facing_mirrors_sum_a_geometric_series() -> None:
    # Seen along the normals: every mirror shows half of its own light and half of the light from the other mirror.
    ends = [Plane((0, 0, z), (0, 0, 1), GREY, mirror=0.5) for z in (-6, 6)]
    for depth in (0, 1, 2, 5):
        expected = 0.4 * sum(0.5**i * 0.5 for i in range(depth + 1)) if depth else 0.4
        assert np.allclose(light(LIGHT, AHEAD, *ends, depth=depth), expected, rtol=1e-13)
    deep = light(LIGHT, AHEAD, *ends, depth=32)
    assert np.allclose(deep, 0.4, atol=2 * MIN_WEIGHT)
    assert (deep < 0.4).all()  # rays below the cut-off weight are not traced


def test_glass_of_refractive_index_1_is_invisible() -> None:
    ball = Sphere((0.3, 0.2, 0), 2, RED, glass=Glass(1.0))
    behind = Sphere((0.1, 0, 8), 3, (10, 200, 30))
    assert np.allclose(light(LIGHT, AHEAD, SKY, ball, behind), light(LIGHT, AHEAD, SKY, behind), rtol=1e-12)


def camera_at(angle: float) -> Camera:
    """A camera at height 1 that looks at the origin, on the floor, so many degrees from the floor's normal."""
    direction = sin(radians(angle)), -cos(radians(angle)), 0.0
    return Camera((-direction[0] / -direction[1], 1.0, 0.0), direction, 1e-4)


def target(angle: float, above: bool) -> Sphere:
    """A small ball in the way of a ray that leaves the origin at an angle to the normal."""
    height = cos(radians(angle)) * (1 if above else -1)
    return Sphere((3 * sin(radians(angle)), 3 * height, 0), 0.02, RED)


@pytest.mark.parametrize("ior", [1.0, 1.33, 1.5, 2.42])
@pytest.mark.parametrize("angle", [0.0, 10.0, 45.0, 80.0])
def test_refraction_follows_snells_law(ior: float, angle: float) -> None:
    floor = Plane((0, 0, 0), (0, 1, 0), WHITE, glass=Glass(ior))
    target_ball = target(degrees(asin(sin(radians(angle)) / ior)), above=False)
    assert np.allclose(light(LIGHT, camera_at(angle), floor, target_ball), [1, 0, 0], atol=1e-12)
    if ior > 1 and angle:
        assert not light(LIGHT, camera_at(angle), floor, target(angle, above=False)).any()  # not refracted


@pytest.mark.parametrize("angle", [5.0, 20.0, 41.0])
def test_refraction_out_of_glass_bends_away_from_the_normal(angle: float) -> None:
    floor = Plane((0, 0, 0), (0, -1, 0), WHITE, glass=Glass(1.5))  # the glass is above
    target_ball = target(degrees(asin(1.5 * sin(radians(angle)))), above=False)
    assert np.allclose(light(LIGHT, camera_at(angle), floor, target_ball), [1, 0, 0], atol=1e-12)


@pytest.mark.parametrize("angle", [42.0, 60.0, 85.0])
def test_beyond_the_critical_angle_reflection_is_total(angle: float) -> None:
    floor = Plane((0, 0, 0), (0, -1, 0), WHITE, glass=Glass(1.5))  # the angle is asin(1 / 1.5), 41.8 degrees
    assert np.allclose(light(LIGHT, SKY, camera_at(angle), floor, target(angle, above=True)), [1, 0, 0], atol=1e-12)


def test_glass_transmits_its_share() -> None:
    pane = Plane((0, 0, 0), (0, 0, -1), GREY, glass=Glass(1.5, 0.5), mirror=0.25)
    assert np.allclose(light(LIGHT, AHEAD, SKY, pane), 0.25 * 0.4 + 0.75 * np.array([0.2, 0.4, 0.8]), rtol=1e-12)


def test_shares_of_more_than_one_are_scaled_down_alike() -> None:
    pane = Plane((0, 0, 0), (0, 0, -1), GREY, glass=Glass(1.5, 1.0), mirror=1.0)
    assert np.allclose(light(LIGHT, AHEAD, SKY, pane), [0.2, 0.4, 0.8], rtol=1e-12)


def transmittance(cosine: float, before: float, behind: float) -> float:
    """Share of the light that is refracted, from the amplitudes of the refracted waves, with 50 digits."""
    with mp.workdps(50):
        c, m, n = mpf(cosine), mpf(before), mpf(behind)
        squared = 1 - (m / n) ** 2 * (1 - c * c)
        if squared <= 0:
            return 0.0
        there = mp.sqrt(squared)
        across, along = 2 * m * c / (m * c + n * there), 2 * m * c / (n * c + m * there)
        return float(n * there / (m * c) * (across**2 + along**2) / 2)


def test_what_is_not_refracted_is_reflected() -> None:
    cosines = np.cos(np.radians([0, 1, 20, 41, 45, 60, 75, 89, 89.999]))
    for n in (1.0, 1.1, 1.33, 1.5, 2.42, 10.0):
        for before, behind in ((1.0, n), (n, 1.0)):
            expected = [1 - transmittance(c, before, behind) for c in cosines]
            assert np.abs(reflectance(cosines, before / behind) - expected).max() < 1e-13


WHITE_WALL, BRIGHT_SKY = (255, 255, 255), Background((51, 102, 204))
BLUE = np.array([0.2, 0.4, 0.8])


def seen_at(angle: float, *shapes: Shape, above: bool = True) -> Array:
    """Light that an eye sees which looks at the origin, so many degrees from the vertical."""
    direction = sin(radians(angle)), -cos(radians(angle)) * (1 if above else -1), 0.0
    eye = Camera((-2 * direction[0], -2 * direction[1], 0), direction, 1e-6)
    return interpreted(Scene((Ambient(1.0, WHITE_WALL), BRIGHT_SKY, eye, *shapes)), 4, 4)[1][0, 0]


FLOOR = Plane((0, 0, 0), (0, 1, 0), WHITE_WALL)
DARK = Plane((0, -50, 0), (0, 1, 0), (0, 0, 0))  # below the floor, and takes all light


@pytest.mark.parametrize("angle", [0.0, 30.0, 56.3, 80.0, 89.0])
def test_glass_reflects_by_the_angle(angle: float) -> None:
    glass = FLOOR.replace(glass=Glass(1.5, 0.9), fresnel=1.0)
    reflected = 1 - transmittance(cos(radians(angle)), 1.0, 1.5)
    assert np.allclose(seen_at(angle, glass, DARK), 0.1 + 0.9 * reflected * BLUE, rtol=1e-6)
    half = glass.replace(fresnel=0.5, mirror=Mirror(0.1), glass=Glass(1.5, 0.7))
    assert np.allclose(seen_at(angle, half, DARK), 0.2 + (0.05 + 0.4 * reflected) * BLUE, rtol=1e-6)


@pytest.mark.parametrize("angle", [5.0, 35.0, 41.7, 42.0])
def test_light_that_leaves_glass_is_reflected_as_light_that_enters(angle: float) -> None:
    glass = FLOOR.replace(glass=Glass(1.5), fresnel=1.0)
    reflected = 1 - transmittance(cos(radians(angle)), 1.5, 1.0)
    expected = (1 - reflected) * BLUE
    assert np.allclose(seen_at(angle, glass, DARK, above=False), expected, rtol=1e-5)


@pytest.mark.parametrize("share", [0.04, 0.3, 1.0])
def test_a_mirror_reflects_its_share_along_the_normal_and_more_elsewhere(share: float) -> None:
    mirror = FLOOR.replace(mirror=Mirror(share), fresnel=1.0)
    n = (1 + sqrt(share)) / (1 - sqrt(share)) if share < 1 else 1e12
    for angle in (0.0, 60.0, 89.9):
        reflected = 1 - transmittance(cos(radians(angle)), 1.0, n)
        for above in (True, False):
            expected = (1 - reflected) + reflected * BLUE
            assert np.allclose(seen_at(angle, mirror, above=above), expected, atol=1e-5)
    assert np.allclose(seen_at(0.0, mirror), (1 - share) + share * BLUE, atol=1e-5)
