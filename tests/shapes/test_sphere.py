"""The sphere's formulas, against answers known by hand; rays that are hard for them are in `tests.stability`."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.shapes import sphere as module
from minirt.shapes.sphere import Sphere
from tests.shapes import mutants
from tests.shapes.checks import U, assert_near, assert_verdicts, errors_of, solved
from tests.shapes.execution_modes import Intersect, on_arrays, surfaces
from tests.shapes.regimes import GREY, RAYS, aimed, just_above, random_directions, sphere

BALL = Sphere((0, 0, 5), 6, GREY)  # radius 3: its edge is seen from the origin along a 3-4-5 triangle
BENIGN = solved(aimed, sphere, 1)


def shoot(intersect: Intersect, shape: Sphere, *rays: tuple[tuple[float, ...], tuple[float, ...]]) -> list[float]:
    """t of rays, each an origin and a direction."""
    padded = [*rays, *[rays[-1]] * (-len(rays) % RAYS)]
    origins, directions = (np.array([ray[part] for ray in padded], float)[None] for part in (0, 1))
    return list(intersect([shape], origins, directions)[0, : len(rays)])


def test_answers_known_by_hand(intersect: Intersect) -> None:
    rays = [
        ((0, 0, 0), (0, 0, 1)),  # head on
        ((0, 0, 0), (0, 0, -1)),  # behind
        ((0, 0, 5), (0.6, 0, 0.8)),  # from the centre
        ((0, 0, 4), (0, 0, -1)),  # from inside, the near wall
        ((0, 0, 4), (0, 0, 1)),  # from inside, the far wall
        ((1.8, 0, 0), (0, 0, 1)),  # 1.8 off the axis: 2.4 before the centre
        ((3, 0, 0), (0, 0, 1)),  # touching it
        ((3.1, 0, 0), (0, 0, 1)),  # past it
        ((0, 0, 9), (0, 0, 1)),  # away from it
    ]
    assert shoot(intersect, BALL, *rays) == pytest.approx([2, np.inf, 3, 2, 4, 2.6, 5, np.inf, np.inf], rel=4e-16)


def test_an_eye_on_the_surface_sees_the_far_wall_or_nothing(intersect: Intersect) -> None:
    inwards, outwards = shoot(intersect, BALL, ((0, 0, 2), (0, 0, 1)), ((0, 0, 2), (0, 0, -1)))
    assert inwards == 6
    assert outwards == np.inf


def test_benign_rays(intersect: Intersect) -> None:
    assert_near(intersect(*BENIGN[0]), BENIGN[1], 1e-13)
    errors = errors_of(intersect, *BENIGN)
    assert errors.max() <= 1e-15
    assert np.sqrt((errors**2).mean()) <= 1e-15


def test_without_the_power_of_the_origin_a_low_height_above_a_huge_sphere_is_lost(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "CLOSE", 0.0)
    rays, right = solved(just_above, 9, 1e-3)
    assert errors_of(on_arrays, rays, right).max() > 1e-6


def test_nan_is_a_miss(intersect: Intersect) -> None:
    assert shoot(intersect, BALL, ((np.nan, 0, 0), (0, 0, 1)), ((0, 0, 0), (0, np.nan, 1))) == [np.inf, np.inf]


def test_the_surface_is_the_nearest_point_and_the_normal_points_outwards() -> None:
    random = np.random.default_rng(8)
    balls = [sphere(random, 1.0, 0.0) for _ in range(20)]
    for ball, out in zip(balls, random_directions(random, 20, RAYS), strict=True):
        points = np.array(ball.centre) + random.uniform(0.1, 3, (RAYS, 1)) * out
        on, normal = surfaces([ball], points[None])
        assert np.abs(normal[0] - out).max() <= 16 * U * 5
        assert np.abs(np.linalg.norm(on[0] - np.array(ball.centre), axis=-1) - ball.diameter / 2).max() <= 8 * U * 5


def test_a_formula_that_accepts_nan_does_not_pass() -> None:
    with pytest.raises(AssertionError):
        test_nan_is_a_miss(mutants.with_formula(mutants.accepts_nan))
    with pytest.raises(AssertionError):
        assert_verdicts(
            mutants.with_formula(lambda *ray: (mutants.accepts_nan(*ray)[0] | True, 1.0))(*BENIGN[0]), BENIGN[1]
        )


def test_its_box_and_its_ball() -> None:
    assert BALL.bounds() == ((-3, -3, 2), (3, 3, 8))
    assert BALL.balls() == (((0, 0, 5), 3),)
