"""The cone's formulas, against answers known by hand; rays that are hard for them are in `tests.stability`."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.shapes.cone import Cone
from tests.shapes.checks import U
from tests.shapes.execution_modes import Intersect, surfaces
from tests.shapes.regimes import GREY
from tests.shapes.test_sphere import shoot

TENT = Cone((0, 4, 5), (0, -1, 0), 6, 4, GREY)  # radius 3 at y = 0: its sides are the long ones of 3-4-5 triangles


def test_answers_known_by_hand(intersect: Intersect) -> None:
    rays = [
        ((0, 2, 0), (0, 0, 1)),  # the side, half-way up
        ((0, 2, 0), (0, 0, -1)),  # behind
        ((0, 9, 5), (0, -1, 0)),  # the apex, along the axis
        ((1.5, 9, 5), (0, -1, 0)),  # the side from above
        ((1.5, -1, 5), (0, 1, 0)),  # the base
        ((3.1, -1, 5), (0, 1, 0)),  # past the rim
        ((0, 1, 5), (0, -1, 0)),  # from inside, the base
        ((0, 1, 5), (0, 1, 0)),  # from inside, the apex
        ((0, 1, 5), (1, 0, 0)),  # from inside, the side
        ((0, 6, 0), (0, 0, 1)),  # over it, where its mirror image would be
        ((0, 6, 5), (0.6, 0.8, 0)),  # within that, upwards
        ((0, 6, 5), (0.6, -0.8, 0)),  # within that, downwards and along the side: never
        ((-3, 0.5, 5), (0.8, 0.6, 0)),  # in, from beside it
    ]
    expected = [3.5, np.inf, 5, 7, 1, np.inf, 1, 3, 2.25, np.inf, np.inf, np.inf, 0.375 / 0.35]
    assert shoot(intersect, TENT, *rays) == pytest.approx(expected, rel=1e-15)


def test_an_eye_on_the_surface_sees_the_far_wall_or_nothing(intersect: Intersect) -> None:
    rays = [((0, 2, 3.5), (0, 0, 1)), ((0, 2, 3.5), (0, 0, -1)), ((0, 0, 5), (0, 1, 0)), ((0, 0, 5), (0, -1, 0))]
    assert shoot(intersect, TENT, *rays) == [3, np.inf, 4, np.inf]


def test_rays_along_its_lines_and_at_its_apex(intersect: Intersect) -> None:
    right = Cone((0, 0, 5), (0, -1, 0), 8, 4, GREY)  # its lines go down as far as they go aside
    rays = [((-2, 2, 5), (1, -1, 0)), ((-2, 2, 6), (1, -1, 0)), ((-4, 2, 5), (2, -1, 0))]
    assert shoot(intersect, right, *rays) == [2, np.inf, 2]  # along one, beside it, at the apex and nowhere else


def test_nan_is_a_miss(intersect: Intersect) -> None:
    rays = [((np.nan, 2, 0), (0, 0, 1)), ((0, np.nan, 0), (0, 0, 1)), ((0, 2, 0), (np.nan, 0, 1))]
    assert shoot(intersect, TENT, *rays) == [np.inf] * 3


def test_the_surface_is_the_side_or_the_base_and_the_normal_points_outwards() -> None:
    points = np.array([[1.508, 2.006, 5], [1, 0.001, 5], [1, -0.01, 5], [0, 4, 5]])
    on, normal = surfaces([TENT], points[None])
    assert np.abs(on[0] - [[1.5, 2, 5], [1, 0, 5], [1, 0, 5], [0, 4, 5]]).max() <= 8 * U * 5
    assert np.abs(normal[0] - [[0.8, 0.6, 0], [0, -1, 0], [0, -1, 0], [0, 1, 0]]).max() <= 4 * U


def test_its_box_and_its_balls() -> None:
    turned = Cone((1, 2, 3), (0.6, 0, 0.8), 10, 20, GREY)
    assert turned.bounds() == (pytest.approx((1, -3, 3)), pytest.approx((17, 7, 22)))
    assert turned.balls() == (((1, 2, 3), 0), (pytest.approx((13, 2, 19)), 5))
