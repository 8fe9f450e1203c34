"""The cylinder's formulas, against answers known by hand; rays that are hard for them are in `tests.stability`."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.shapes import cylinder as module
from minirt.shapes.cylinder import Cylinder
from tests.shapes import mutants
from tests.shapes.checks import U, assert_near, errors_of, solved
from tests.shapes.execution_modes import Intersect, on_arrays, surfaces
from tests.shapes.regimes import (
    GREY,
    aimed,
    along_axis,
    cylinder,
)
from tests.shapes.test_sphere import shoot

TUBE = Cylinder((0, 0, 5), (0, 1, 0), 6, 4, GREY)  # radius 3, from y = -2 to y = 2
BENIGN = solved(aimed, cylinder, 1)
ALONG = solved(along_axis, 4, None)


def test_answers_known_by_hand(intersect: Intersect) -> None:
    rays = [
        ((0, 0, 0), (0, 0, 1)),  # the side, head on
        ((0, 0, 0), (0, 0, -1)),  # behind
        ((0, 0, 5), (1, 0, 0)),  # from the centre to the side
        ((0, 0, 5), (0, 1, 0)),  # from the centre to the cap, along the axis
        ((0, 9, 5), (0, -1, 0)),  # the cap from above
        ((2.9, 9, 5), (0, -1, 0)),  # the cap near its rim
        ((3.1, 9, 5), (0, -1, 0)),  # past the rim
        ((1.8, 0, 0), (0, 0, 1)),  # 1.8 off the axis: 2.4 before it
        ((0, 2.1, 0), (0, 0, 1)),  # over it
        ((0, 5, 5), (0.6, -0.8, 0)),  # the cap at x = 2.25
        ((0, -1.9, 5), (0.6, -0.8, 0)),  # from inside, the bottom
        ((0, 0, 5), (0.8, 0.6, 0)),  # from inside, the cap before the side
    ]
    expected = [2, np.inf, 3, 2, 7, 7, np.inf, 2.6, np.inf, 3.75, 0.125, 10 / 3]
    assert shoot(intersect, TUBE, *rays) == pytest.approx(expected, rel=1e-15)
    assert shoot(intersect, TUBE.replace(axis=(0, -1, 0)), *rays) == pytest.approx(expected, rel=1e-15)


def test_an_eye_on_the_surface_sees_the_far_wall_or_nothing(intersect: Intersect) -> None:
    rays = [((0, 0, 2), (0, 0, 1)), ((0, 0, 2), (0, 0, -1)), ((0, 2, 5), (0, -1, 0)), ((0, 2, 5), (0, 1, 0))]
    assert shoot(intersect, TUBE, *rays) == [6, np.inf, 4, np.inf]


def test_benign_rays(intersect: Intersect) -> None:
    assert_near(intersect(*BENIGN[0]), BENIGN[1], 1e-13)
    assert np.sqrt((errors_of(intersect, *BENIGN) ** 2).mean()) <= 1e-15


def test_nan_is_a_miss(intersect: Intersect) -> None:
    rays = [((np.nan, 0, 0), (0, 0, 1)), ((0, np.nan, 0), (0, 0, 1)), ((0, 0, 0), (np.nan, 0, 1))]
    assert shoot(intersect, TUBE, *rays) == [np.inf] * 3


def test_the_surface_is_the_side_or_the_cap_and_the_normal_points_outwards() -> None:
    points = np.array([[3.001, 1, 5], [0, 0, 1.99], [2, 2.001, 5], [2, 1.999, 5], [1, -2.01, 5], [0, -1.99, 5]])
    on, normal = surfaces([TUBE], points[None])
    expected = [[3, 1, 5], [0, 0, 2], [2, 2, 5], [2, 2, 5], [1, -2, 5], [0, -2, 5]]
    assert np.abs(on[0] - expected).max() <= 8 * U * 5
    assert np.abs(normal[0] - [[1, 0, 0], [0, 0, -1], [0, 1, 0], [0, 1, 0], [0, -1, 0], [0, -1, 0]]).max() <= 4 * U


def test_a_naive_quadratic_does_not_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "negative_interval", mutants.naive_quadratic)
    assert_near(on_arrays(*BENIGN[0]), BENIGN[1], 1e-11)  # it is right where nothing is hard
    with pytest.raises(AssertionError):
        assert_near(on_arrays(*ALONG[0]), ALONG[1], 1e-13)


def test_its_box_and_its_balls() -> None:
    turned = Cylinder((1, 2, 3), (0.6, 0, 0.8), 10, 20, GREY)
    assert turned.bounds() == (pytest.approx((-9, -3, -8)), pytest.approx((11, 7, 14)))
    assert turned.balls() == ((pytest.approx((7, 2, 11)), 5), (pytest.approx((-5, 2, -5)), 5))


def test_the_box_of_a_wide_disc_that_is_hardly_tilted() -> None:
    # Its rim rises by radius times tilt, though 1 - cos^2 of the tilt is nothing in float64.
    disc = Cylinder((0, 0, 0), (1e-9, 1, 0), 2e6, 1e-6, GREY)
    _, (_, top, _) = disc.bounds()
    assert top == pytest.approx(1e6 * 1e-9 + 5e-7, rel=1e-12)
