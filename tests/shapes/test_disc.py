"""The disc's formulas, against answers known by hand; rays that are hard for them are in `tests.stability`."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.shapes.disc import Disc
from tests.shapes.checks import U
from tests.shapes.execution_modes import Intersect, surfaces
from tests.shapes.regimes import GREY
from tests.shapes.test_sphere import shoot

PLATE = Disc((0, 1, 5), (0.6, 0, -0.8), 4, GREY)  # radius 2, turned by a 3-4-5 triangle


def test_answers_known_by_hand(intersect: Intersect) -> None:
    rays = [
        ((0, 1, 0), (0, 0, 1)),
        ((0, 1, 0), (0, 0, -1)),  # behind
        ((0, 1, 9), (0, 0, -1)),  # from its back
        ((1.59, 1, 0), (0, 0, 1)),  # near the rim: 3/4 of that deeper
        ((1.61, 1, 0), (0, 0, 1)),  # past it
        ((0, 2.99, 0), (0, 0, 1)),
        ((0, 3, 0), (0, 0, 1)),  # the very rim
        ((0, 3.01, 0), (0, 0, 1)),
        ((1.2, 2.4, 0), (0, 0, 1)),  # where a square would be: 1.5 aside and 1.4 up
        ((-1, 1, 4.25), (0.8, 0, 0.6)),  # along it
        ((0, 1, 5), (0, 0, 1)),  # from it
    ]
    expected = [5, np.inf, 4, 5 + 0.75 * 1.59, np.inf, 5, 5, np.inf, np.inf, np.inf, np.inf]
    assert shoot(intersect, PLATE, *rays) == pytest.approx(expected, rel=1e-15)
    assert shoot(intersect, PLATE.replace(normal=(-0.6, 0, 0.8)), *rays) == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize(("slope", "seen"), [(1e-6, True), (np.nextafter(4 * U, 1), True), (4 * U, False), (0, False)])
def test_a_parallel_ray_misses(intersect: Intersect, slope: float, seen: bool) -> None:
    floor = PLATE.replace(normal=(0, 1, 0))
    (t,) = shoot(intersect, floor, ((0, 1, 5.5), (1, -slope, 0)), ((0, 1 + slope, 5), (1, -slope, 0)))[1:]
    assert t == (pytest.approx(1, abs=1e-3 if slope > U * 8 else 1) if seen else np.inf)


def test_nan_is_a_miss(intersect: Intersect) -> None:
    rays = [((np.nan, 1, 0), (0, 0, 1)), ((0, np.nan, 0), (0, 0, 1)), ((0, 1, 0), (0, np.nan, 1))]
    assert shoot(intersect, PLATE, *rays) == [np.inf] * 3


def test_points_are_projected_onto_the_plane() -> None:
    on, normal = surfaces([PLATE], np.array([[[0.06, 2, 4.92], [0.8, 1, 5.6]]]))
    assert np.abs(on[0] - [[0, 2, 5], [0.8, 1, 5.6]]).max() <= 8 * U * 5
    assert np.array_equal(normal[0], [PLATE.normal] * 2)


def test_its_box_and_its_ball() -> None:
    assert PLATE.bounds() == (pytest.approx((-1.6, -1, 3.8)), pytest.approx((1.6, 3, 6.2)))
    assert PLATE.balls() == (((0, 1, 5), 2),)
