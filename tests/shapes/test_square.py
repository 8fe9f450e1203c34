"""The square's formulas, against answers known by hand; rays that are hard for them are in `tests.stability`."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.shapes.square import Square
from tests.shapes.checks import U
from tests.shapes.execution_modes import Intersect, surfaces
from tests.shapes.regimes import GREY
from tests.shapes.test_sphere import shoot

BOARD = Square((0, 1, 5), (0.6, 0, -0.8), 4, GREY)  # 2 to each side, turned by a 3-4-5 triangle, and upright


def test_answers_known_by_hand(intersect: Intersect) -> None:
    rays = [
        ((0, 1, 0), (0, 0, 1)),
        ((0, 1, 0), (0, 0, -1)),  # behind
        ((0, 1, 9), (0, 0, -1)),  # from its back
        ((1.59, 2.99, 0), (0, 0, 1)),  # near a corner: 3/4 of that deeper
        ((1.61, 2.99, 0), (0, 0, 1)),  # beside it
        ((1.59, 3.01, 0), (0, 0, 1)),  # over it
        ((-1.59, -0.99, 0), (0, 0, 1)),
        ((-1.61, 0, 0), (0, 0, 1)),
        ((0, -1.01, 0), (0, 0, 1)),
        ((0, 3, 0), (0, 0, 1)),  # the very edge
        ((-1, 1, 5.0 - 0.75), (0.8, 0, 0.6)),  # along it
        ((0, 1, 5), (0, 0, 1)),  # from it
    ]
    expected = [5, np.inf, 4, 5 + 0.75 * 1.59, np.inf, np.inf, 5 - 0.75 * 1.59, np.inf, np.inf, 5, np.inf, np.inf]
    assert shoot(intersect, BOARD, *rays) == pytest.approx(expected, rel=1e-15)
    assert shoot(intersect, BOARD.replace(normal=(0, 0, -1)), ((2, 1, 0), (0, 0, 1)), ((2.01, 1, 0), (0, 0, 1))) == [
        5,
        np.inf,
    ]
    assert shoot(intersect, BOARD.replace(normal=(-0.6, 0, 0.8)), *rays) == pytest.approx(expected, rel=1e-15)


def test_a_floor_has_its_edges_along_x_and_z(intersect: Intersect) -> None:
    floor = BOARD.replace(normal=(0, 1, 0))
    rays = [((1.99, 3, 6.99), (0, -1, 0)), ((2.01, 3, 5), (0, -1, 0)), ((0, 3, 7.01), (0, -1, 0))]
    assert shoot(intersect, floor, *rays) == [2, np.inf, np.inf]


@pytest.mark.parametrize(("slope", "seen"), [(1e-6, True), (np.nextafter(4 * U, 1), True), (4 * U, False), (0, False)])
def test_a_parallel_ray_misses(intersect: Intersect, slope: float, seen: bool) -> None:
    floor = BOARD.replace(normal=(0, 1, 0))
    (t,) = shoot(intersect, floor, ((0, 1 + slope, 5), (1, -slope, 0)))
    assert t == (pytest.approx(1, abs=1e-3 if slope > U * 8 else 1) if seen else np.inf)


def test_nan_is_a_miss(intersect: Intersect) -> None:
    rays = [((np.nan, 1, 0), (0, 0, 1)), ((0, np.nan, 0), (0, 0, 1)), ((0, 1, 0), (0, np.nan, 1))]
    assert shoot(intersect, BOARD, *rays) == [np.inf] * 3


def test_points_are_projected_onto_the_plane() -> None:
    on, normal = surfaces([BOARD], np.array([[[0.06, 2, 4.92], [0.8, 1, 5.6]]]))
    assert np.abs(on[0] - [[0, 2, 5], [0.8, 1, 5.6]]).max() <= 8 * U * 5
    assert np.array_equal(normal[0], [BOARD.normal] * 2)


def test_its_box_and_its_balls() -> None:
    assert BOARD.bounds() == (pytest.approx((-1.6, -1, 3.8)), pytest.approx((1.6, 3, 6.2)))
    assert len(BOARD.balls()) == 4
    assert sorted(centre for centre, _ in BOARD.balls())[0] == pytest.approx((-1.6, -1, 3.8))
    assert {radius for _, radius in BOARD.balls()} == {0}
