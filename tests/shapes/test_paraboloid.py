"""The paraboloid's formulas, against answers known by hand; rays that are hard for them are in `tests.stability`."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.shapes.paraboloid import Paraboloid
from tests.shapes.checks import U
from tests.shapes.execution_modes import Intersect, surfaces
from tests.shapes.regimes import GREY
from tests.shapes.test_sphere import shoot

BOWL = Paraboloid((0, -1, 5), (0, 1, 0), 4, 4, GREY)  # x^2 + (z - 5)^2 = y + 1, from y = -1 to y = 3


def test_answers_known_by_hand(intersect: Intersect) -> None:
    rays = [
        ((0, 0, 0), (0, 0, 1)),  # the side
        ((0, 0, 0), (0, 0, -1)),  # behind
        ((0, -3, 5), (0, 1, 0)),  # the vertex, along the axis
        ((1, -3, 5), (0, 1, 0)),  # the side, along the axis
        ((1, 9, 5), (0, -1, 0)),  # the cap
        ((2.1, 9, 5), (0, -1, 0)),  # past the rim
        ((0, 0, 5), (0, 1, 0)),  # from inside, the cap
        ((0, 0, 5), (0, -1, 0)),  # from inside, the vertex
        ((0, 1.25, 5), (1, 0, 0)),  # from inside, the side
        ((0, 3.1, 0), (0, 0, 1)),  # over it
        ((0, -1.1, 0), (0, 0, 1)),  # under it
        ((0, 5, 5), (1, -1, 0)),  # the rim and nothing else
        ((0.25, -0.25, 5), (-0.6, 0.8, 0)),  # from inside: 0.36 t^2 - 1.1 t = 0.6875
    ]
    slanted = (1.1 + (1.21 + 4 * 0.36 * 0.6875) ** 0.5) / 0.72
    expected = [4, np.inf, 2, 3, 6, np.inf, 3, 1, 1.5, np.inf, np.inf, 2, slanted]
    assert shoot(intersect, BOWL, *rays) == pytest.approx(expected, rel=2e-15)


def test_an_eye_on_the_surface_sees_the_far_wall_or_nothing(intersect: Intersect) -> None:
    rays = [((0, 0, 4), (0, 0, 1)), ((0, 0, 4), (0, 0, -1)), ((0, 3, 5), (0, -1, 0)), ((0, 3, 5), (0, 1, 0))]
    assert shoot(intersect, BOWL, *rays) == [2, np.inf, 4, np.inf]


def test_nan_is_a_miss(intersect: Intersect) -> None:
    rays = [((np.nan, 0, 0), (0, 0, 1)), ((0, np.nan, 0), (0, 0, 1)), ((0, 0, 0), (np.nan, 0, 1))]
    assert shoot(intersect, BOWL, *rays) == [np.inf] * 3


def test_the_surface_is_the_side_or_the_cap_and_the_normal_points_outwards() -> None:
    points = np.array([[1.01, 0, 5], [0, -1.01, 5], [0.25, -0.9, 5], [1, 3.01, 5], [1, 2.99, 5]])
    on, normal = surfaces([BOWL], points[None])
    # Across the axis where the side is steep, along it where it is flat.
    assert np.abs(on[0] - [[1, 0, 5], [0, -1, 5], [0.25, -0.9375, 5], [1, 3, 5], [1, 3, 5]]).max() <= 8 * U * 5
    slopes = [np.array([2, -1, 0]) / 5**0.5, [0, -1, 0], np.array([0.5, -1, 0]) / 1.25**0.5, [0, 1, 0], [0, 1, 0]]
    assert np.abs(normal[0] - slopes).max() <= 4 * U


def test_points_move_across_the_axis_where_the_side_is_steep() -> None:
    on, normal = surfaces([BOWL], np.array([[[0.76, -0.4375, 5], [0.6, -1.01, 5]]]))
    assert np.abs(on[0, 0] - [0.75, -0.4375, 5]).max() <= 8 * U * 5
    assert np.abs(normal[0, 0] - np.array([1.5, -1, 0]) / 3.25**0.5).max() <= 4 * U
    assert np.abs(normal[0, 1] - [0, -1, 0]).max() <= 4 * U  # below the vertex


def test_near_the_rim_points_move_to_the_nearer_wall() -> None:
    over = 1e-4  # and this far, times (1 + 17^0.5) / 4, beside the rim both walls are as near
    points = np.array([[2 + aside * over, 3 + over, 5] for aside in (1.275, 1.287)])
    _, normal = surfaces([BOWL], points[None])
    assert np.abs(normal[0] - [[0, 1, 0], np.array([4, -1, 0]) / 17**0.5]).max() <= 1e-4


def test_its_box_and_its_balls() -> None:
    assert BOWL.bounds() == ((-2, -1, 3), (2, 3, 7))
    assert BOWL.balls() == (((0, -1, 5), 1), ((0, 3, 5), 2))
    # Lying on its side, its box is that of the rim and the vertex; tilted a little, it bulges beyond both.
    assert BOWL.replace(axis=(1, 0, 0)).bounds() == ((0, -3, 3), (4, 1, 7))
    low, high = BOWL.replace(axis=(0.6, 0.8, 0)).bounds()
    assert low == pytest.approx((-2 * 0.8 * 0.5 * 0.8 / 1.2 * 0.5, -1 - 0.5 * 2 * 0.6 * 2 * 0.6 / (2 * 4 * 0.8), 3))
    assert high == pytest.approx((2.4 + 1.6, -1 + 3.2 + 1.2, 7))


def test_its_box_has_the_bulges_that_lie_below_the_rim_and_no_others() -> None:
    # Along y the outermost point is 3 / 4 as far from the axis as the rim, along x it would be 4 / 3 as far.
    dish = Paraboloid((0, 0, 0), (0.6, 0.8, 0), 4, 1, GREY)
    assert dish.bounds() == (pytest.approx((-1, -0.45, -2)), pytest.approx((2.2, 2, 2)))
    over = dish.replace(axis=(-0.6, -0.8, 0))
    assert over.bounds() == (pytest.approx((-2.2, -2, -2)), pytest.approx((1, 0.45, 2)))
