"""The plane's formulas, against answers known by hand and against 60 digits."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.shapes.plane import Plane
from tests.shapes import mutants
from tests.shapes.checks import U, assert_near, errors_of, posed
from tests.shapes.regimes import GREY, RAYS, Rays, across, log, unit, ways
from tests.shapes.test_sphere import shoot
from tests.shapes.ways import Intersect, surfaces

FLOOR = Plane((7, -2, 9), (0, 1, 0), GREY)


def planes(seed: int, offset: float = 0.0, grazing: tuple[float, float] = (0.05, 1.0), count: int = 50) -> Rays:
    """At planes from 1 to 20 above them, at slopes in `grazing`; half of them look away from it."""
    random = np.random.default_rng(seed)
    normals = ways(random, count)
    points = offset * ways(random, count) + random.normal(size=(count, 3))
    shapes = [Plane(tuple(p), tuple(n.clip(-1, 1)), GREY) for p, n in zip(points, normals, strict=True)]
    normals = np.array([shape.normal for shape in shapes])[:, None]
    aside = unit(np.cross(ways(random, count, RAYS), normals))
    slope = log(random, *grazing, count, RAYS, 1) * random.choice([-1.0, 1.0], (count, RAYS, 1))
    origins = points[:, None] + 3 * aside + random.uniform(1, 20, (count, RAYS, 1)) * normals
    directions = unit(across(random, normals, count, RAYS) * np.sqrt(1 - slope**2) + slope * normals)
    return Rays(shapes, origins, directions)


def test_answers_known_by_hand(way: Intersect) -> None:
    rays = [
        ((0, 0, 0), (0, -1, 0)),
        ((0, 0, 0), (0, 1, 0)),
        ((0, -5, 0), (0, 1, 0)),  # from below
        ((0, 1, 0), (0.8, -0.6, 0)),
        ((0, 1, 0), (1, 0, 0)),  # along it
        ((0, -2, 0), (1, 0, 0)),  # in it
        ((0, -2, 0), (0, -1, 0)),  # from it
    ]
    expected = [2, np.inf, 3, 5, np.inf, np.inf, np.inf]
    assert shoot(way, FLOOR, *rays) == pytest.approx(expected, rel=4e-16)
    assert shoot(way, FLOOR.replace(normal=(0, -1, 0)), *rays) == pytest.approx(expected, rel=4e-16)


def test_benign_rays(way: Intersect) -> None:
    rays, right = posed(planes, 1)
    assert_near(way(*rays), right, 1e-13)
    assert np.sqrt((errors_of(way, rays, right) ** 2).mean()) <= 1e-15


def test_far_from_the_origin(way: Intersect) -> None:
    rays, right = posed(planes, 2, 1e8)  # coordinates to 1.5e-8, which does not matter: they are what is given
    assert_near(way(*rays), right, 1e-13)


def test_grazing_rays_are_as_exact_as_their_slope(way: Intersect) -> None:
    # A slope s is the difference of numbers near 1 and known to some 2^-53 / s of itself.
    rays, right = posed(planes, 3, 0.0, (1e-6, 1e-2))
    assert_near(way(*rays), right, 8 * U / 1e-6)


@pytest.mark.parametrize(("slope", "seen"), [(1e-6, True), (1e-10, True), (np.nextafter(4 * U, 1), True), (4 * U, False), (0.0, False)])
def test_a_ray_along_the_plane_misses_it(way: Intersect, slope: float, seen: bool) -> None:
    (t,) = shoot(way, FLOOR, ((0, 0, 0), (1, -slope, 0)))
    assert t == (pytest.approx(2 / slope, rel=4e-16) if seen else np.inf)


def test_the_surface_is_the_foot_of_the_perpendicular() -> None:
    points = np.random.default_rng(4).normal(size=(1, RAYS, 3))
    on, normal = surfaces([FLOOR], points)
    assert np.array_equal(on[..., ::2], points[..., ::2])
    assert np.abs(on[..., 1] + 2.0).max() <= 4 * U
    assert np.array_equal(normal, np.broadcast_to([0.0, 1.0, 0.0], (1, RAYS, 3)))


def test_a_plane_that_is_hit_behind_the_eye_does_not_pass() -> None:
    rays, right = posed(planes, 1)
    with pytest.raises(AssertionError, match="false hit"):
        assert_near(mutants.way(mutants.hits_behind)(*rays), right, 1e-13)
