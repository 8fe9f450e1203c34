"""The plane's formulas, against answers known by hand; rays that are hard for them are in `tests.stability`."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.shapes.plane import Plane
from tests.shapes.checks import U
from tests.shapes.execution_modes import Intersect, surfaces
from tests.shapes.regimes import GREY, RAYS
from tests.shapes.test_sphere import shoot

FLOOR = Plane((7, -2, 9), (0, 1, 0), GREY)


def test_answers_known_by_hand(intersect: Intersect) -> None:
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
    assert shoot(intersect, FLOOR, *rays) == pytest.approx(expected, rel=4e-16)
    assert shoot(intersect, FLOOR.replace(normal=(0, -1, 0)), *rays) == pytest.approx(expected, rel=4e-16)


@pytest.mark.parametrize(
    ("slope", "seen"), [(1e-6, True), (1e-10, True), (np.nextafter(4 * U, 1), True), (4 * U, False), (0.0, False)]
)
def test_a_parallel_ray_misses(intersect: Intersect, slope: float, seen: bool) -> None:
    (t,) = shoot(intersect, FLOOR, ((0, 0, 0), (1, -slope, 0)))
    assert t == (pytest.approx(2 / slope, rel=4e-16) if seen else np.inf)


def test_points_are_projected_onto_the_plane() -> None:
    points = np.random.default_rng(4).normal(size=(1, RAYS, 3))
    on, normal = surfaces([FLOOR], points)
    assert np.array_equal(on[..., ::2], points[..., ::2])
    assert np.abs(on[..., 1] + 2.0).max() <= 4 * U
    assert np.array_equal(normal, np.broadcast_to([0.0, 1.0, 0.0], (1, RAYS, 3)))
