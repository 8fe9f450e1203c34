"""The box's formulas, against answers known by hand; rays that are hard for them are in `tests.stability`."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.shapes.box import Box
from tests.shapes.checks import U
from tests.shapes.execution_modes import Intersect, surfaces
from tests.shapes.mapping_checks import interpreted
from tests.shapes.regimes import GREY
from tests.shapes.test_sphere import shoot

BLOCK = Box((0, 1, 5), (0, 1, 0), (2, 4, 6), GREY)  # from -1, -1, 2 to 1, 3, 8


def test_answers_known_by_hand(intersect: Intersect) -> None:
    rays = [
        ((0, 0, 0), (0, 0, 1)),
        ((0, 0, 0), (0, 0, -1)),  # behind
        ((0, 0, 9), (0, 0, -1)),
        ((0, 9, 5), (0, -1, 0)),
        ((-9, 1, 5), (1, 0, 0)),
        ((0, 1, 5), (1, 0, 0)),  # from the centre
        ((0, 1, 5), (0, 1, 0)),
        ((0, 1, 5), (0, 0, 1)),
        ((0.99, 2.99, 0), (0, 0, 1)),  # near an edge
        ((1.01, 0, 0), (0, 0, 1)),  # past it on each side
        ((-1.01, 0, 0), (0, 0, 1)),
        ((0, 3.01, 0), (0, 0, 1)),
        ((0, -1.01, 0), (0, 0, 1)),
        ((-9, 1, 8.01), (1, 0, 0)),
        ((-4, 0, 5), (0.6, 0.8, 0)),  # over it
        ((-2.5, 0, 5), (0.6, 0.8, 0)),  # at the side, 2 up
        ((-2, 2, 5), (0.5**0.5, 0.5**0.5, 0)),  # at the very edge
    ]
    expected = [2, np.inf, 1, 6, 8, 1, 2, 3, 2] + [np.inf] * 6 + [2.5, 2**0.5]
    assert shoot(intersect, BLOCK, *rays) == pytest.approx(expected, rel=1e-15)
    assert shoot(intersect, BLOCK.replace(axis=(0, -1, 0)), *rays) == pytest.approx(expected, rel=1e-15)


def test_its_axes_are_those_of_the_scene_until_it_is_turned() -> None:
    axes = [
        [tuple(v) for v in np.round([(a.x, a.y, a.z) for a in BLOCK.replace(axis=axis).axes()], 12)]
        for axis in ((0, 1, 0), (1, 0, 0), (0, 0, 1), (0.6, 0.8, 0))
    ]
    assert axes[0] == [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    assert axes[1] == [(0, -1, 0), (1, 0, 0), (0, 0, 1)]
    assert axes[2] == [(1, 0, 0), (0, 0, 1), (0, -1, 0)]
    assert axes[3] == [(0.8, -0.6, 0), (0.6, 0.8, 0), (0, 0, 1)]


def test_an_eye_on_the_surface_sees_the_far_wall_or_nothing(intersect: Intersect) -> None:
    rays = [((0, 0, 2), (0, 0, 1)), ((0, 0, 2), (0, 0, -1)), ((0, 3, 5), (0, -1, 0)), ((0, 3, 5), (0, 1, 0))]
    assert shoot(intersect, BLOCK, *rays) == [6, np.inf, 4, np.inf]


def test_nan_is_a_miss(intersect: Intersect) -> None:
    rays = [((np.nan, 0, 0), (0, 0, 1)), ((0, np.nan, 0), (0, 0, 1)), ((0, 0, 0), (np.nan, 0, 1))]
    assert shoot(intersect, BLOCK, *rays) == [np.inf] * 3


def test_the_surface_is_the_nearest_face_and_the_normal_points_outwards() -> None:
    points = np.array([[1.01, 0, 5], [-0.99, 0, 5], [0, 3.01, 5], [0, -0.99, 5], [0, 0, 2.01], [0.5, 2, 8.01]])
    on, normal = surfaces([BLOCK], points[None])
    assert np.abs(on[0] - [[1, 0, 5], [-1, 0, 5], [0, 3, 5], [0, -1, 5], [0, 0, 2], [0.5, 2, 8]]).max() <= 8 * U * 5
    assert normal[0].tolist() == [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, -1], [0, 0, 1]]


def test_its_box_and_its_balls() -> None:
    assert BLOCK.bounds() == ((-1, -1, 2), (1, 3, 8))
    assert len(BLOCK.balls()) == 8
    assert {radius for _, radius in BLOCK.balls()} == {0}
    turned = BLOCK.replace(axis=(0.6, 0.8, 0))
    assert turned.bounds() == (pytest.approx((-2, -1.2, 2)), pytest.approx((2, 3.2, 8)))


def test_pictures_are_as_wide_and_high_as_its_faces() -> None:
    faces = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
    found = interpreted(BLOCK, BLOCK.centre + faces * [1, 2, 3], faces)
    right = [[0, 0, -6], [0, 0, 6], [2, 0, 0], [2, 0, 0], [2, 0, 0], [-2, 0, 0]]
    up = [[0, 4, 0], [0, 4, 0], [0, 0, -6], [0, 0, 6], [0, 4, 0], [0, 4, 0]]
    assert found.along_u.tolist() == right
    assert found.along_v.tolist() == up
