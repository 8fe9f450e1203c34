"""Culling of triangles by pyramids: no ray that hits is culled, and most others are."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from minirt.kernel.shading.shade import clearance
from minirt.lanes import Vec
from minirt.shapes.triangle import PackedTriangle, Triangle, intersect, may_meet
from tests.shapes.regimes import GREY

COUNT = 4000
REGIMES = [(1.0, 0.0, 5.0), (1e-3, 0.0, 5.0), (1.0, 1e6, 5.0), (1e-4, 10.0, 5e3), (300.0, 0.0, 1.0), (1.0, 0.0, 0.01)]
REGIMES += [(1e-11, 0.0, 1e-10)]
FAR = 1e6  # as many times as far behind the triangle as the apex is before it
PLACES = {  # where 0 is, and how the three corners lie beside the apex
    "as drawn": lambda corners, apex, random: (corners, apex),
    "a corner at 0": lambda corners, apex, random: (corners - corners[0], apex - corners[0]),
    "the middle at 0": lambda corners, apex, random: (corners - corners.mean(0), apex - corners.mean(0)),
    "the apex at 0": lambda corners, apex, random: (corners - apex, 0 * apex),
    "the apex at 0, near corners": lambda corners, apex, random: (
        10.0 ** random.choice([-5, 0], (3, 1)) * (corners - apex),
        0 * apex,
    ),
    "the apex at 0, near an edge": lambda corners, apex, random: (
        corners - corners[:2].mean(0) + 1e-5 * random.normal(size=3),
        0 * apex,
    ),
    "far starts at 0": lambda corners, apex, random: seen_from(corners, apex, 1 + FAR),
    "half-way to far starts at 0": lambda corners, apex, random: seen_from(corners, apex, (1 + FAR) / 2),
}
CASES = [(regime, "as drawn", number) for regime in REGIMES for number in (np.float64, np.float32)]
CASES += [(REGIMES[i], place, np.float64) for i in (0, 5) for place in PLACES]


def vec(points: Any, number: type) -> Vec:
    return Vec(*np.asarray(points, number).T)


def packed(corners: Any, normal: Any, number: type = np.float64) -> PackedTriangle:
    return PackedTriangle(*(vec(each, number) for each in (*corners, normal)))


def seen_from(corners: Any, apex: Any, share: float) -> tuple[Any, Any]:
    """Corners and apex, moved so that the origin lies behind the middle of an edge, `far` times as far from the
    apex."""
    start = apex + share * (corners[:2].mean(0) - apex)
    return corners - start, apex - start


def drawn(
    seed: int, size: float, offset: float, distance: float, number: type, place: str = "as drawn"
) -> tuple[Any, ...]:
    """A triangle, an apex away from it, and points inside the triangle, on its edges and at its corners."""
    random = np.random.default_rng(seed)
    middle = offset * random.normal(size=3)
    given = middle + size * random.normal(size=(3, 3)), middle + distance * random.normal(size=3)
    corners, apex = (each.astype(number).astype(float) for each in PLACES[place](*given, random))
    normal = np.array(Triangle(*map(tuple, corners.tolist()), GREY).normal())
    shares = random.dirichlet(np.ones(3), COUNT)
    shares[::4, 0] = 0
    shares[::8, 1] = 0
    shares /= shares.sum(axis=1, keepdims=True)
    return corners, apex, normal, np.roll(shares, seed, axis=1) @ corners, random


@pytest.mark.parametrize(("regime", "place", "number"), CASES)
@pytest.mark.parametrize("seed", range(8))
def test_no_ray_that_hits_is_culled(seed: int, regime: tuple[float, float, float], place: str, number: type) -> None:
    corners, apex, normal, points, random = drawn(seed, *regime, number, place)
    triangle = packed(corners, normal, number)
    origin, everything = vec(apex, number), np.ones(COUNT, bool)
    beside = random.normal(size=(COUNT, 3)) @ (corners - corners[0])  # in the plane
    middle = corners[:2].mean(0)  # of an edge
    points[::16] = middle + 1e-5 * (points[::16] - middle)
    points = points + 10.0 ** random.uniform(-20, -7, (COUNT, 1)) * beside
    away = points - apex
    near, far = (10.0 ** random.integers(*powers, (COUNT, 1)) for powers in ((-18, -5), (-3, 9)))
    # From the apex, from the triangle and from behind it towards the apex, also from so far that they do not quite get
    # there.
    for start in (None, points + near * away, points + far * away):
        begin = np.broadcast_to(apex, points.shape) if start is None else start.astype(number).astype(float)
        aim = away if start is None else apex - begin
        direction = vec(aim / np.linalg.norm(aim, axis=1, keepdims=True), number)
        with np.errstate(all="ignore"):  # float32 may not tell corners so far away apart
            hit, _ = intersect(triangle, vec(begin, number), direction)
        tried = may_meet(triangle, origin, None if start is None else vec(begin, number), direction, everything)
        assert hit.mean() > 0.1 or number is np.float32  # those that start on the triangle do not
        assert not (hit & ~tried).any()


@pytest.mark.parametrize("seed", range(20))
def test_rays_beside_the_triangle_are_culled(seed: int) -> None:
    corners, apex, normal, _, random = drawn(seed, 1.0, 10.0, 5.0, np.float64)
    outside = random.dirichlet(np.ones(3), COUNT)
    outside[:, 0] = -(10.0 ** random.uniform(-6, 2, COUNT))
    outside[:, 1] = 1 - outside[:, 0] - outside[:, 2]
    aim = outside @ corners - apex
    direction = vec(aim / np.linalg.norm(aim, axis=1, keepdims=True), np.float64)
    given = packed(corners, normal), vec(apex, np.float64)
    assert not may_meet(*given, None, direction, np.ones(COUNT, bool)).any()


@pytest.mark.parametrize("number", [np.float64, np.float32])
@pytest.mark.parametrize("seed", range(20))
def test_rays_that_leave_a_triangle_are_culled_for_it(seed: int, number: type) -> None:
    corners, apex, normal, points, _ = drawn(seed, 1.0, 10.0, 50.0, number)
    normal = normal * np.sign(normal @ (apex - corners[0]))
    point, up = vec(points, number), vec(normal, number)
    rounding = clearance(point, number(np.abs(corners).max()))
    assert rounding.dtype == number
    start = point + rounding * up
    aim = apex - points
    direction = vec(aim / np.linalg.norm(aim, axis=1, keepdims=True), number)
    for side in (1.0, -1.0):
        triangle = packed(corners, side * normal, number)
        tried = may_meet(triangle, vec(apex, number), start, direction, np.ones(COUNT, bool))
        assert not tried.any()


def test_inactive_rays_stay_inactive() -> None:
    corners, apex, normal, points, _ = drawn(3, 1.0, 0.0, 5.0, np.float64)
    aim = points - apex
    direction = vec(aim / np.linalg.norm(aim, axis=1, keepdims=True), np.float64)
    asked = np.arange(COUNT) % 3 == 0
    given = packed(corners, normal), vec(apex, np.float64)
    assert np.array_equal(may_meet(*given, None, direction, asked), asked)
    assert np.array_equal(may_meet(*given, vec(points + aim, np.float64), direction, asked), asked)
