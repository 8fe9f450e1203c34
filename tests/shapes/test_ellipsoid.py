"""The ellipsoid's formulas, against answers known by hand; rays that are hard for them are in `tests.stability`."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.lanes import Vec
from minirt.shapes import ellipsoid as module
from minirt.shapes.ellipsoid import Ellipsoid, PackedEllipsoid
from minirt.shapes.sphere import Sphere
from tests.shapes import mutants
from tests.shapes.checks import U
from tests.shapes.execution_modes import Intersect, surfaces
from tests.shapes.regimes import GREY, RAYS, aimed, sphere
from tests.shapes.test_sphere import shoot

EGG = Ellipsoid((0, 0, 5), (0, 1, 0), (4, 2, 6), GREY)  # semi-axes 2, 1 and 3 along x, y and z
TURNED = Ellipsoid((0, 0, 5), (1, 0, 0), (4, 2, 6), GREY)  # 1, 2 and 3: its y axis is the scene's x


def test_answers_known_by_hand(intersect: Intersect) -> None:
    rays = [
        ((0, 0, 0), (0, 0, 1)),  # the near end of the longest axis
        ((0, 0, 0), (0, 0, -1)),  # behind
        ((0, 0, 5), (1, 0, 0)),  # from the centre, along each axis
        ((0, 0, 5), (0, -1, 0)),
        ((0, 0, 4), (0, 0, -1)),  # from inside, the near wall
        ((1.2, 0, 0), (0, 0, 1)),  # x / 2 = 0.6: z is 0.8 of 3 off the centre
        ((0, 0.6, 0), (0, 0, 1)),  # y / 1 = 0.6, too
        ((2, 0, 0), (0, 0, 1)),  # touching it
        ((2.01, 0, 0), (0, 0, 1)),  # past it
        ((0, 0, 9), (0, 0, 1)),  # away from it
    ]
    expected = [2, np.inf, 2, 1, 2, 2.6, 2.6, 5, np.inf, np.inf]
    assert shoot(intersect, EGG, *rays) == pytest.approx(expected, rel=4e-16)


def test_its_sizes_are_along_its_own_axes(intersect: Intersect) -> None:
    rays = [((0, 0, 5), (1, 0, 0)), ((0, 0, 5), (0, 1, 0)), ((0, 0, 5), (0, 0, 1))]
    assert shoot(intersect, TURNED, *rays) == pytest.approx([1, 2, 3], rel=4e-16)


def test_an_eye_on_the_surface_sees_the_far_wall_or_nothing(intersect: Intersect) -> None:
    assert shoot(intersect, EGG, ((0, 0, 2), (0, 0, 1)), ((0, 0, 2), (0, 0, -1))) == [6, np.inf]


def test_with_three_equal_sizes_it_is_a_sphere(intersect: Intersect) -> None:
    rays = aimed(sphere, 1)
    for ball, origins, directions in zip(rays.shapes[:8], rays.origins, rays.directions, strict=False):
        assert isinstance(ball, Sphere)
        same = Ellipsoid(ball.centre, (0.6, 0.64, 0.48), (ball.diameter,) * 3, GREY)
        one, other = (intersect([shape], origins[None], directions[None])[0] for shape in (ball, same))
        assert np.array_equal(np.isinf(one), np.isinf(other))
        seen = np.isfinite(one)
        assert np.abs(one[seen] - other[seen]).max(initial=0) <= 1e-13


def test_nan_is_a_miss(intersect: Intersect) -> None:
    rays = [((np.nan, 0, 0), (0, 0, 1)), ((0, np.nan, 0), (0, 0, 1)), ((0, 0, 0), (np.nan, 0, 1))]
    assert shoot(intersect, EGG, *rays) == [np.inf] * 3


def test_points_move_onto_the_surface_along_the_normal() -> None:
    on = np.array([[2, 0, 5], [0, -1, 5], [1.2, 0.8, 5], [0, 0.6, 5 - 2.4]])
    slopes = np.array([[1, 0, 0], [0, -1, 0], [0.3, 0.8, 0], [0, 0.6, -2.4 / 9]])
    normals = slopes / np.linalg.norm(slopes, axis=-1, keepdims=True)
    for off in (1e-9, -1e-9):
        points, found = surfaces([EGG], (on + off * normals)[None])
        assert np.abs(points[0] - on).max() <= 8 * U * 5
        assert np.abs(found[0] - normals).max() <= 1e-8


def test_its_box_and_its_balls() -> None:
    assert EGG.bounds() == ((-2, -1, 2), (2, 1, 8))
    assert TURNED.bounds() == (pytest.approx((-1, -2, 2)), pytest.approx((1, 2, 8)))
    assert sorted(EGG.balls()) == [((x, 0, z), 1) for x in (-1, 1) for z in (3, 7)]


def from_the_origin(ellipsoid: PackedEllipsoid, origin: Vec, direction: Vec) -> object:
    """The formula with t counted from the origin of the ray instead of its closest approach."""
    p = module.scaled(
        module.to_basis(ellipsoid.u, ellipsoid.v, ellipsoid.w, origin - ellipsoid.centre), ellipsoid.scale
    )
    d = module.scaled(module.to_basis(ellipsoid.u, ellipsoid.v, ellipsoid.w, direction), ellipsoid.scale)
    a, b, c = module.dot(d, d), module.dot(p, d), module.dot(p, p) - 1.0
    hit, near, far = module.negative_interval(a, 1.0 / a, b, c, c)
    return hit & (far > 0.0), np.where(near > 0.0, near, far)


def test_counted_from_the_origin_of_the_ray_a_small_ellipsoid_far_away_is_lost() -> None:
    pebble = EGG.replace(centre=(0, 0, 1e6), sizes=(4e-3, 2e-3, 6e-3))
    rays = [((0, 0, 0), (0, 0, 1))] * RAYS
    assert shoot(mutants.with_formula(module.intersect), pebble, *rays)[0] == pytest.approx(1e6 - 3e-3, rel=1e-15)
    assert shoot(mutants.with_formula(from_the_origin), pebble, *rays)[0] != pytest.approx(1e6 - 3e-3, rel=1e-10)
