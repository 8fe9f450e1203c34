"""The cylinder's formulas, against answers known by hand and against 60 digits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from minirt.shapes import cylinder as module
from minirt.shapes.cylinder import Cylinder
from tests.shapes import mutants
from tests.shapes.checks import U, assert_between, assert_near, errors_of, posed
from tests.shapes.regimes import (
    GREY,
    Rays,
    aimed,
    along_axis,
    cylinder,
    disc,
    from_the_wall,
    inside,
    inside_tube,
    rim,
    tangent_to_side,
)
from tests.shapes.test_sphere import shoot
from tests.shapes.ways import Intersect, on_arrays, surfaces

TUBE = Cylinder((0, 0, 5), (0, 1, 0), 6, 4, GREY)  # radius 3, from y = -2 to y = 2
BENIGN = posed(aimed, cylinder, 1)
FAR = [posed(aimed, cylinder, 2, 1.0, (1e2, 1e6)), posed(aimed, cylinder, 3, 1.0, (3.0, 20.0), 1e8)]
ALONG = {
    "exactly": posed(along_axis, 4, None),
    "exactly, offset": posed(along_axis, 5, None, 1e8),
    "nearly": posed(along_axis, 6, (1e-12, 1e-3)),
    "nearly, offset": posed(along_axis, 7, (1e-12, 1e-3), 1e8),
}
RIM = posed(rim, 8)
LONG = posed(inside_tube, 9)
WALL = posed(from_the_wall, 13)


def test_answers_known_by_hand(way: Intersect) -> None:
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
    assert shoot(way, TUBE, *rays) == pytest.approx(expected, rel=1e-15)
    assert shoot(way, TUBE.replace(axis=(0, -1, 0)), *rays) == pytest.approx(expected, rel=1e-15)


def test_an_eye_on_the_surface_sees_the_far_wall_or_nothing(way: Intersect) -> None:
    rays = [((0, 0, 2), (0, 0, 1)), ((0, 0, 2), (0, 0, -1)), ((0, 2, 5), (0, -1, 0)), ((0, 2, 5), (0, 1, 0))]
    assert shoot(way, TUBE, *rays) == [6, np.inf, 4, np.inf]


def test_benign_rays(way: Intersect) -> None:
    assert_near(way(*BENIGN[0]), BENIGN[1], 1e-13)
    assert np.sqrt((errors_of(way, *BENIGN) ** 2).mean()) <= 1e-15


@pytest.mark.parametrize("rays", FAR, ids=["far", "offset"])
def test_far_away(way: Intersect, rays: tuple[Rays, Any]) -> None:
    assert_near(way(*rays[0]), rays[1], 1e-13)


@pytest.mark.parametrize("name", ALONG)
def test_along_the_axis(way: Intersect, name: str) -> None:
    assert_near(way(*ALONG[name][0]), ALONG[name][1], 1e-13)


def test_the_rim_has_no_crack(way: Intersect) -> None:
    assert_between(way(*RIM[0]), RIM[1], 1e-13)
    assert errors_of(way, *RIM).max() <= 1e-12


def test_tangents_to_the_side(way: Intersect) -> None:
    rays, right = posed(tangent_to_side, 10)
    assert_between(way(*rays), right, 1e-13)
    assert errors_of(way, rays, right).max() <= 1e-6


def test_from_inside(way: Intersect) -> None:
    rays, right = posed(inside, cylinder, 11)
    assert_near(way(*rays), right, 1e-13)
    assert np.isfinite(way(*rays)).all()


def test_inside_a_tube_of_height_1e9(way: Intersect) -> None:
    # 1e-8 off the axis, an axis that is exact to 2^-53 leaves 1e-8 of the angle, and so of t.
    assert_near(way(*LONG[0]), LONG[1], 3e-8)


def test_across_a_tube_from_its_wall(way: Intersect) -> None:
    assert_near(way(*WALL[0]), WALL[1], 1e-13)


def test_a_disc_of_height_1e_9(way: Intersect) -> None:
    rays, right = posed(disc, 12)
    assert_near(way(*rays), right, 1e-13)


def test_nan_is_a_miss(way: Intersect) -> None:
    rays = [((np.nan, 0, 0), (0, 0, 1)), ((0, np.nan, 0), (0, 0, 1)), ((0, 0, 0), (np.nan, 0, 1))]
    assert shoot(way, TUBE, *rays) == [np.inf] * 3


def test_the_surface_is_the_side_or_the_cap_and_the_normal_points_outwards() -> None:
    points = np.array([[3.001, 1, 5], [0, 0, 1.99], [2, 2.001, 5], [2, 1.999, 5], [1, -2.01, 5], [0, -1.99, 5]])
    on, normal = surfaces([TUBE], points[None])
    expected = [[3, 1, 5], [0, 0, 2], [2, 2, 5], [2, 2, 5], [1, -2, 5], [0, -2, 5]]
    assert np.abs(on[0] - expected).max() <= 8 * U * 5
    assert np.abs(normal[0] - [[1, 0, 0], [0, 0, -1], [0, 1, 0], [0, 1, 0], [0, -1, 0], [0, -1, 0]]).max() <= 4 * U


def test_piece_by_piece_does_not_pass() -> None:
    naive = mutants.way(mutants.piece_by_piece)
    assert_near(naive(*BENIGN[0]), BENIGN[1], 1e-11)  # it is right where nothing is hard
    for hard, tolerance in ((FAR[0], 1e-13), (RIM, 1e-12)):
        with pytest.raises(AssertionError):
            assert_near(naive(*hard[0]), hard[1], tolerance)


@pytest.mark.parametrize(("mutant", "hard"), [(mutants.no_sign, WALL), (mutants.two_roots, ALONG["exactly"])])
def test_a_naive_quadratic_does_not_pass(monkeypatch: pytest.MonkeyPatch, mutant: Any, hard: Any) -> None:
    monkeypatch.setattr(module, "below_zero", mutant)
    assert_near(on_arrays(*BENIGN[0]), BENIGN[1], 1e-11)  # it is right where nothing is hard
    with pytest.raises(AssertionError):
        assert_near(on_arrays(*hard[0]), hard[1], 1e-13)


def test_the_box_of_a_wide_disc_that_is_hardly_tilted() -> None:
    # Its rim rises by radius times tilt, though 1 - cos^2 of the tilt is nothing in float64.
    disc = Cylinder((0, 0, 0), (1e-9, 1, 0), 2e6, 1e-6, GREY)
    _, (_, top, _) = disc.bounds()
    assert top == pytest.approx(1e6 * 1e-9 + 5e-7, rel=1e-12)
