"""The hyperboloid's formulas, against answers known by hand; rays that are hard for them are in `tests.stability`."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.errors import ElementError
from minirt.shapes.hyperboloid import Hyperboloid
from tests.shapes.checks import U
from tests.shapes.execution_modes import Intersect, surfaces
from tests.shapes.regimes import GREY
from tests.shapes.test_sphere import shoot

EVEN = Hyperboloid((0, 0, 5), (0, 1, 0), 15, 17, 8, GREY)  # x^2 + (z - 5)^2 = 7.5^2 + y^2, exactly
TOWER = Hyperboloid((0, 0, 5), (0, 1, 0), 6, 10, 8, GREY)  # x^2 + (z - 5)^2 = 9 + y^2, from y = -4 to y = 4


def test_answers_known_by_hand(intersect: Intersect) -> None:
    rays = [
        ((0, 0, -5), (0, 0, 1)),  # the waist
        ((0, 0, -5), (0, 0, -1)),  # behind
        ((0, 9, 5), (0, -1, 0)),  # the cap, along the axis
        ((4.9, 9, 5), (0, -1, 0)),  # the cap near its rim
        ((5.1, 9, 5), (0, -1, 0)),  # past the rim
        ((0, 0, 5), (0, 1, 0)),  # from the centre, the cap
        ((0, 0, 5), (1, 0, 0)),  # from the centre, the side
        ((4.9, 3.95, 5), (0, -1, 0)),  # from inside, out of the side above the waist
        ((4.9, 0, 5), (0, -1, 0)),  # from beside the waist, into the lower half
        ((4.9, -3.95, 5), (0, -1, 0)),  # from inside there, the lower cap
        ((0, 4.1, -5), (0, 0, 1)),  # over it
    ]
    side = (4.9**2 - 9) ** 0.5
    expected = [7, np.inf, 5, 5, np.inf, 4, 3, 3.95 - side, side, 0.05, np.inf]
    assert shoot(intersect, TOWER, *rays) == pytest.approx(expected, rel=3e-15)


def test_a_hole_is_seen_through(intersect: Intersect) -> None:
    # From x = 4 a ray down the outside of the waist enters above it, leaves, and enters again below.
    x, side = 4, 7**0.5
    rays = [((x, y, 5), (0, -1, 0)) for y in (9, 3.9, 2, 0, -3, -5)]
    assert shoot(intersect, TOWER, *rays) == pytest.approx([5, 3.9 - side, 2 + side, side, 1, np.inf], rel=1e-15)


def test_an_eye_on_the_surface_sees_what_comes_next_or_nothing(intersect: Intersect) -> None:
    rays = [((0, 0, -2.5), (0, 0, 1)), ((0, 0, -2.5), (0, 0, -1)), ((0, 4, 5), (0, -1, 0)), ((0, 4, 5), (0, 1, 0))]
    # Down past the waist: out of the upper half at y = 3.125, into the lower one at -3.125, and out of its cap.
    rays += [((8.125, y, 5), (0, -1, 0)) for y in (3.125, -3.125, -4)]
    assert shoot(intersect, EVEN, *rays) == [15, np.inf, 8, np.inf, 6.25, 0.875, np.inf]


def test_rays_along_its_asymptotes_and_at_its_rim(intersect: Intersect) -> None:
    rays = [((-6, -6, 12), (1, 1, 0)), ((-6, -6, 13), (1, 1, 0)), ((4.5, 6, 5), (2, -1, 0))]
    assert shoot(intersect, EVEN, *rays) == [2, np.inf, 2]  # inside of it, beside it, at the rim and nowhere else


def test_hits_from_far_away_are_exact(intersect: Intersect) -> None:
    assert shoot(intersect, TOWER, ((-6.6e8, 0, 5 - 8.8e8), (0.6, 0, 0.8))) == pytest.approx([1.1e9 - 3], rel=1e-15)


def test_nan_is_a_miss(intersect: Intersect) -> None:
    rays = [((np.nan, 0, 0), (0, 0, 1)), ((0, np.nan, 0), (0, 0, 1)), ((0, 0, 0), (np.nan, 0, 1))]
    assert shoot(intersect, TOWER, *rays) == [np.inf] * 3


def test_with_a_waist_as_wide_as_the_ends_it_is_a_cylinder(intersect: Intersect) -> None:
    tube = Hyperboloid((0, 0, 5), (0, 1, 0), 6, 6, 4, GREY)
    rays = [((1.8, 0, 0), (0, 0, 1)), ((2.9, 9, 5), (0, -1, 0)), ((0, 0, 5), (0.8, 0.6, 0))]
    assert shoot(intersect, tube, *rays) == pytest.approx([2.6, 7, 10 / 3], rel=1e-15)
    on, normal = surfaces([tube], np.array([[[3.01, 1, 5]]]))
    assert np.abs(on[0] - [3, 1, 5]).max() <= 8 * U * 5
    assert np.abs(normal[0] - [1, 0, 0]).max() <= 4 * U


def test_the_surface_is_the_side_or_a_cap_and_the_normal_points_outwards() -> None:
    points = np.array([[3.01, 0, 5], [-5.01, 3.9, 5], [1, 4.01, 5], [1, -3.99, 5]])
    on, normal = surfaces([TOWER], points[None])
    reach = (9 + 3.9**2) ** 0.5
    assert np.abs(on[0] - [[3, 0, 5], [-reach, 3.9, 5], [1, 4, 5], [1, -4, 5]]).max() <= 8 * U * 5
    slopes = [[1, 0, 0], np.array([-reach, -3.9, 0]) / (9 + 2 * 3.9**2) ** 0.5, [0, 1, 0], [0, -1, 0]]
    assert np.abs(normal[0] - slopes).max() <= 4 * U


def test_points_move_along_the_axis_where_the_side_is_flat() -> None:
    dish = Hyperboloid((0, 0, 5), (0, 1, 0), 6, 10, 2, GREY)  # x^2 + (z - 5)^2 = 9 + 16 y^2, from y = -1 to y = 1
    on, normal = surfaces([dish], np.array([[[4, 0.65, 5], [4, -0.65, 5]]]))
    height = 7**0.5 / 4
    assert np.abs(on[0] - [[4, height, 5], [4, -height, 5]]).max() <= 8 * U * 5
    down = np.array([4, -16 * height, 0]) / np.hypot(4, 16 * height)
    assert np.abs(normal[0] - [down, down * [1, -1, 1]]).max() <= 4 * U


def test_near_the_rim_points_move_to_the_nearer_wall() -> None:
    over = 1e-4  # and this far, times (4 + 41^0.5) / 5, beside the rim both walls are as near
    points = np.array([[5 + aside * over, 4 + over, 5] for aside in (2.07, 2.09)])
    _, normal = surfaces([TOWER], points[None])
    assert np.abs(normal[0] - [[0, 1, 0], np.array([5, -4, 0]) / 41**0.5]).max() <= 1e-4


def test_points_inside_the_waist_move_onto_it() -> None:
    dish = Hyperboloid((0, 0, 5), (0, 1, 0), 6, 10, 2, GREY)  # 4 y is more than x: put there along the axis
    on, normal = surfaces([dish], np.array([[[2.9, 0.2, 5]]]))
    assert on[0, 0, 1] == 0
    assert np.abs(normal[0, 0] - [1, 0, 0]).max() <= 4 * U


def test_its_box_and_its_balls() -> None:
    turned = Hyperboloid((1, 2, 3), (0.6, 0, 0.8), 4, 10, 20, GREY)
    assert turned.bounds() == (pytest.approx((-9, -3, -8)), pytest.approx((11, 7, 14)))
    assert turned.balls() == ((pytest.approx((-5, 2, -5)), 5), (pytest.approx((7, 2, 11)), 5))


def test_a_waist_wider_than_the_ends_is_refused() -> None:
    with pytest.raises(ElementError, match="hyperboloid waist must be at most the diameter, 5, got 6"):
        TOWER.replace(diameter=5)
    assert TOWER.replace(diameter=6).diameter == 6
