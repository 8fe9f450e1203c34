"""Fresnel's equations against values that are known from elsewhere, and their shares in pictures."""

from __future__ import annotations

from collections.abc import Callable
from math import acos, asin, atan, cos, radians, sin, sqrt

import numpy as np
import pytest
from mpmath import mp, mpf

from minirt.kernel.shading.surfaces import reflectance
from minirt.materials import Glass, Mirror
from minirt.scene import Ambient, Background, Camera, Scene
from minirt.shapes import Shape
from minirt.shapes.plane import Plane
from tests.kernel.pictures import Array, interpreted

INDICES = [1.0, 1.1, 1.33, 1.5, 2.42, 10.0]
Reflectance = Callable[[Array, float], Array]


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


def largest_error(formula: Reflectance) -> float:
    """The largest error of the reflected shares, for rays that enter and that leave media of several indices."""
    cosines = np.cos(np.radians([0, 1, 20, 41, 45, 60, 75, 89, 89.999]))
    errors = [
        np.abs(formula(cosines, before / behind) - [1 - transmittance(c, before, behind) for c in cosines])
        for n in INDICES
        for before, behind in ((1.0, n), (n, 1.0))
    ]
    return float(np.max(errors))


def test_what_is_not_refracted_is_reflected() -> None:
    assert largest_error(reflectance) < 1e-13


def swapped_media(cosine: Array, ratio: float) -> Array:
    return reflectance(cosine, 1.0 / ratio)


def one_polarisation(cosine: Array, ratio: float) -> Array:
    behind = np.sqrt(np.maximum(1 - ratio**2 * (1 - cosine**2), 0))
    return ((ratio * cosine - behind) / (ratio * cosine + behind)) ** 2


def schlick(cosine: Array, ratio: float) -> Array:
    normal = ((1 - ratio) / (1 + ratio)) ** 2
    return normal + (1 - normal) * (1 - cosine) ** 5


@pytest.mark.parametrize("wrong", [swapped_media, one_polarisation, schlick])
def test_wrong_equations_are_noticed(wrong: Reflectance) -> None:
    with np.errstate(invalid="ignore"):
        assert largest_error(wrong) > 0.01


@pytest.mark.parametrize("n", INDICES)
def test_along_the_normal_and_along_the_surface(n: float) -> None:
    for ratio in (1 / n, n):
        assert reflectance(np.float64(1), ratio) == pytest.approx(((n - 1) / (n + 1)) ** 2, rel=1e-13, abs=1e-30)
    if n > 1:
        assert reflectance(np.float64(0), 1 / n) == reflectance(np.float64(0), n) == 1.0


@pytest.mark.parametrize("n", INDICES)
def test_at_brewsters_angle_one_polarisation_is_refracted_wholly(n: float) -> None:
    expected = ((n * n - 1) / (n * n + 1)) ** 2 / 2
    assert reflectance(np.float64(cos(atan(n))), 1 / n) == pytest.approx(expected, rel=1e-13, abs=1e-30)


@pytest.mark.parametrize("n", INDICES[1:])
def test_reflection_is_total_beyond_the_critical_angle(n: float) -> None:
    critical = asin(1 / n)
    assert reflectance(np.cos(critical + np.array([1e-9, 0.01, 0.3])), n).tolist() == [1.0] * 3
    assert reflectance(np.float64(cos(critical - 1e-4)), n) < 1.0


WHITE, SKY = (255, 255, 255), Background((51, 102, 204))
BLUE = np.array([0.2, 0.4, 0.8])


def seen_at(angle: float, *shapes: Shape, above: bool = True) -> Array:
    """Light that an eye sees which looks at the origin, so many degrees from the vertical."""
    direction = sin(radians(angle)), -cos(radians(angle)) * (1 if above else -1), 0.0
    eye = Camera((-2 * direction[0], -2 * direction[1], 0), direction, 1e-6)
    return interpreted(Scene((Ambient(1.0, WHITE), SKY, eye, *shapes)), 4, 4)[1][0, 0]


FLOOR = Plane((0, 0, 0), (0, 1, 0), WHITE)
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
    assert acos(seen_at(89.9, mirror)[0]) > acos(seen_at(0.0, mirror)[0]) or share == 1.0
