"""The gaps between triangles, their normals and their culling; hard rays are in `tests.stability`."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from minirt.errors import ElementError
from minirt.kernel.trace import clearance
from minirt.lanes import Vec
from minirt.shapes.plane_normals import plane_normals
from minirt.shapes.triangle import PackedTriangle, Triangle, may_meet
from minirt.shapes.triangle import intersect as watertight
from tests.seeds import seed_of
from tests.shapes.execution_modes import Intersect, U
from tests.shapes.regimes import GREY, RAYS, Array, Random, log_uniform, random_directions, unit
from tests.stability.mutants import in_single_precision


def fan(random: Random) -> tuple[Array, list[Triangle]]:
    """A closed fan of triangles around a point, and that point: the middle of a bowl of seven corners."""
    turns = np.sort(random.uniform(0, 2 * np.pi, 7)) + np.arange(7) * 1e-3
    rim = np.stack([np.cos(turns), np.sin(turns), random.uniform(-0.2, 0.2, 7)], axis=-1)
    scale, middle = log_uniform(random, 1e-3, 1e3), 10 * random.normal(size=3)
    frame = np.linalg.qr(random.normal(size=(3, 3)))[0]
    corners = scale * rim @ frame + middle
    return middle, [
        Triangle(tuple(middle), tuple(corners[i]), tuple(corners[(i + 1) % 7]), GREY)
        if random.random() < 0.5
        else Triangle(tuple(corners[(i + 1) % 7]), tuple(corners[i]), tuple(middle), GREY)
        for i in range(7)
        if (turns[(i + 1) % 7] - turns[i]) % (2 * np.pi) < np.pi
    ]


def gaps(intersect: Intersect) -> int:
    """Number of rays towards shared edges and corners that pass between the triangles."""
    random = np.random.default_rng(5)
    missed = 0
    for _ in range(60):
        middle, triangles = fan(random)
        if len(triangles) < 7:
            continue
        outer = np.array([each.b if each.a == tuple(middle) else each.a for each in triangles])
        share = random.uniform(0, 0.9, (4 * RAYS, 1)) * random.integers(0, 2, (4 * RAYS, 1))
        targets = middle + share * (outer[random.integers(7, size=4 * RAYS)] - middle)
        size = np.linalg.norm(outer[0] - middle)
        normal = np.mean(
            [each.normal() if each.a == tuple(middle) else np.negative(each.normal()) for each in triangles], axis=0
        )
        directions = unit(random_directions(random, 4 * RAYS) - 2 * unit(normal))
        origins = targets - size * log_uniform(random, 1, 100, 4 * RAYS, 1) * directions
        towards = unit(targets - origins)
        met = np.zeros(4 * RAYS, bool)
        for each in triangles:
            met |= np.isfinite(intersect([each], origins[None], towards[None])[0])
        missed += int((~met).sum())
    return missed


def test_no_ray_passes_between_triangles(intersect: Intersect) -> None:
    assert gaps(intersect) == 0


def test_no_ray_passes_between_triangles_in_single_precision() -> None:
    assert gaps(in_single_precision) == 0


def test_grazing_rays_meet_a_triangle_of_any_size_alike(intersect: Intersect) -> None:
    """Whether a ray grazes, and is clamped to the triangle, is no question of the unit of length."""
    random, scale = np.random.default_rng(seed_of("grazing rays")), 2.0**40
    triangles = [corners for corners in random.integers(-8, 9, (12, 3, 3)).astype(float) if not is_thin(corners)]
    hits = 0
    for corners in triangles:
        small, large = (Triangle(*map(tuple, k * corners), GREY) for k in (1.0, scale))
        inside, other = random.dirichlet([1, 1, 1], (2, RAYS)) @ corners
        rise = random.choice([0.0, 1e-12, 1e-8, 1e-5, 1e-3], (RAYS, 1)) * random.choice([-1, 1], (RAYS, 1))
        origins = inside - random.choice([1, 100, 1e4], (RAYS, 1)) * (other - inside + rise * small.normal())
        rays = origins[None], unit(inside - origins)[None]
        t = intersect([small], *rays)
        assert np.array_equal(intersect([large], scale * rays[0], rays[1]), scale * t)
        hits += int(np.isfinite(t).sum())
    assert hits > len(triangles)


def is_thin(corners: Array) -> bool:
    """Whether corners of integers lie on a line."""
    return not np.cross(corners[1] - corners[0], corners[2] - corners[0]).any()


def test_a_triangle_that_is_too_thin_is_refused() -> None:
    # Its longest edge is 4 and its largest coordinate 8: it must be higher than 16 roundings of 8.
    limit = 16 * U * 8
    with pytest.raises(ElementError, match="must not lie on a line with a and b"):
        Triangle((4, 0, 0), (8, 0, 0), (6, limit, 0), GREY)
    assert Triangle((4, 0, 0), (8, 0, 0), (6, np.nextafter(limit, 1), 0), GREY).normal() == (0, 0, 1)


def normal_errors(normal_of: Callable[[Triangle], Array]) -> Array:
    """Errors of the normals of slivers with heights of 1e-12 to 1 of their length, against exact fractions."""
    random = np.random.default_rng(7)
    errors = []
    for height in log_uniform(random, 1e-12, 1, 200):
        a, edge, aside = random.normal(size=(3, 3)) * [[1], [random.uniform(0.5, 4)], [height]]
        sliver = Triangle(tuple(a), tuple(a + edge), tuple(a + random.uniform(0.2, 0.8) * edge + aside), GREY)
        to_b, to_c = (
            [Fraction(y) - Fraction(x) for x, y in zip(sliver.a, p, strict=True)] for p in (sliver.b, sliver.c)
        )
        exact = [to_b[i - 2] * to_c[i - 1] - to_b[i - 1] * to_c[i - 2] for i in range(3)]
        exact = unit(np.array([float(x / max(map(abs, exact))) for x in exact]))
        errors.append(np.linalg.norm(normal_of(sliver) - exact))
    return np.array(errors)


def of_mesh(triangle: Triangle) -> Array:
    """The normal of a triangle as that of a mesh; only the side comes from the approximate one."""
    corners = np.array([[*triangle.a, *triangle.b, *triangle.c]])
    normal: Array = plane_normals(corners, np.array([triangle.normal()]) + 0.1)[0]
    return normal


def plain(triangle: Triangle) -> Array:
    a, b, c = (np.array(corner) for corner in (triangle.a, triangle.b, triangle.c))
    return unit(np.cross(b - a, c - a))


def test_the_normals_of_slivers_are_exact() -> None:
    assert normal_errors(lambda triangle: np.array(triangle.normal())).max() <= 4 * U
    assert normal_errors(of_mesh).max() <= 4 * U
    assert normal_errors(plain).max() > 1e-6


def test_corners_of_a_mesh_that_lie_on_a_line_keep_the_approximate_normal() -> None:
    corners = np.array([[0.0, 0, 0, 1, 1, 1, 3, 3, 3]])
    assert plane_normals(corners, np.array([[0.0, 0, -1]])).tolist() == [[0, 0, -1]]


# Culling by pyramids: no ray that hits is culled, and most others are.
COUNT = 4000
REGIMES = [(1.0, 0.0, 5.0), (1e-3, 0.0, 5.0), (1.0, 1e6, 5.0), (1e-4, 10.0, 5e3), (300.0, 0.0, 1.0), (1.0, 0.0, 0.01)]
REGIMES += [(1e-11, 0.0, 1e-10)]
FAR = 1e6  # as many times as far behind the triangle as the apex is before it
PLACES = {  # where 0 is, and how the three corners lie beside the apex
    "as drawn": lambda corners, apex, random: (corners, apex),
    "a corner at 0": lambda corners, apex, random: (corners - corners[0], apex - corners[0]),
    "the middle at 0": lambda corners, apex, random: (corners - corners.mean(0), apex - corners.mean(0)),
    "the apex at 0": lambda corners, apex, random: (corners - apex, 0 * apex),
    "the apex at 0, near corners": lambda corners, apex, random: (
        10.0 ** random.choice([-5, 0], (3, 1)) * (corners - apex),
        0 * apex,
    ),
    "the apex at 0, near an edge": lambda corners, apex, random: (
        corners - corners[:2].mean(0) + 1e-5 * random.normal(size=3),
        0 * apex,
    ),
    "far starts at 0": lambda corners, apex, random: seen_from(corners, apex, 1 + FAR),
    "half-way to far starts at 0": lambda corners, apex, random: seen_from(corners, apex, (1 + FAR) / 2),
}
CASES = [(regime, "as drawn", number) for regime in REGIMES for number in (np.float64, np.float32)]
CASES += [(REGIMES[i], place, np.float64) for i in (0, 5) for place in PLACES]


def vec(points: Any, number: type) -> Vec:
    return Vec(*np.asarray(points, number).T)


def packed(corners: Any, normal: Any, number: type = np.float64) -> PackedTriangle:
    return PackedTriangle(*(vec(each, number) for each in (*corners, normal)))


def seen_from(corners: Any, apex: Any, share: float) -> tuple[Any, Any]:
    """Corners and apex, moved so that the origin lies behind the middle of an edge, `far` times as far from the
    apex."""
    start = apex + share * (corners[:2].mean(0) - apex)
    return corners - start, apex - start


def drawn(
    seed: int, size: float, offset: float, distance: float, number: type, place: str = "as drawn"
) -> tuple[Any, ...]:
    """A triangle, an apex away from it, and points inside the triangle, on its edges and at its corners."""
    random = np.random.default_rng(seed)
    middle = offset * random.normal(size=3)
    given = middle + size * random.normal(size=(3, 3)), middle + distance * random.normal(size=3)
    corners, apex = (each.astype(number).astype(float) for each in PLACES[place](*given, random))
    normal = np.array(Triangle(*map(tuple, corners.tolist()), GREY).normal())
    shares = random.dirichlet(np.ones(3), COUNT)
    shares[::4, 0] = 0
    shares[::8, 1] = 0
    shares /= shares.sum(axis=1, keepdims=True)
    return corners, apex, normal, np.roll(shares, seed, axis=1) @ corners, random


@pytest.mark.parametrize(("regime", "place", "number"), CASES)
@pytest.mark.parametrize("seed", range(3))
def test_no_ray_that_hits_is_culled(seed: int, regime: tuple[float, float, float], place: str, number: type) -> None:
    corners, apex, normal, points, random = drawn(seed, *regime, number, place)
    triangle = packed(corners, normal, number)
    origin, everything = vec(apex, number), np.ones(COUNT, bool)
    beside = random.normal(size=(COUNT, 3)) @ (corners - corners[0])  # in the plane
    middle = corners[:2].mean(0)  # of an edge
    points[::16] = middle + 1e-5 * (points[::16] - middle)
    points = points + 10.0 ** random.uniform(-20, -7, (COUNT, 1)) * beside
    away = points - apex
    near, far = (10.0 ** random.integers(*powers, (COUNT, 1)) for powers in ((-18, -5), (-3, 9)))
    # From the apex, from the triangle and from behind it towards the apex, also from so far that they do not quite get
    # there.
    for start in (None, points + near * away, points + far * away):
        begin = np.broadcast_to(apex, points.shape) if start is None else start.astype(number).astype(float)
        aim = away if start is None else apex - begin
        direction = vec(aim / np.linalg.norm(aim, axis=1, keepdims=True), number)
        with np.errstate(all="ignore"):  # float32 may not tell corners so far away apart
            hit, _ = watertight(triangle, vec(begin, number), direction)
        tried = may_meet(triangle, origin, None if start is None else vec(begin, number), direction, everything)
        assert hit.mean() > 0.1 or number is np.float32  # those that start on the triangle do not
        assert not (hit & ~tried).any()


@pytest.mark.parametrize(("number", "distance", "least"), [(np.float64, 5.0, -6), (np.float32, 500.0, 0)])
@pytest.mark.parametrize("seed", range(5))
def test_rays_beside_the_triangle_are_culled(seed: int, number: type, distance: float, least: int) -> None:
    corners, apex, normal, _, random = drawn(seed, 1.0, 10.0, distance, number)
    outside = random.dirichlet(np.ones(3), COUNT)
    outside[:, 0] = -(10.0 ** random.uniform(least, 2, COUNT))
    outside[:, 1] = 1 - outside[:, 0] - outside[:, 2]
    aim = outside @ corners - apex
    direction = vec(aim / np.linalg.norm(aim, axis=1, keepdims=True), number)
    given = packed(corners, normal, number), vec(apex, number)
    assert not may_meet(*given, None, direction, np.ones(COUNT, bool)).any()


@pytest.mark.parametrize("number", [np.float64, np.float32])
@pytest.mark.parametrize("seed", range(5))
def test_rays_that_leave_a_triangle_are_culled_for_it(seed: int, number: type) -> None:
    corners, apex, normal, points, _ = drawn(seed, 1.0, 10.0, 50.0, number)
    normal = normal * np.sign(normal @ (apex - corners[0]))
    point, up = vec(points, number), vec(normal, number)
    rounding = clearance(point, number(np.abs(corners).max()))
    assert rounding.dtype == number
    start = point + rounding * up
    aim = apex - points
    direction = vec(aim / np.linalg.norm(aim, axis=1, keepdims=True), number)
    for side in (1.0, -1.0):
        triangle = packed(corners, side * normal, number)
        tried = may_meet(triangle, vec(apex, number), start, direction, np.ones(COUNT, bool))
        assert not tried.any()


def test_inactive_rays_stay_inactive() -> None:
    corners, apex, normal, points, _ = drawn(3, 1.0, 0.0, 5.0, np.float64)
    direction, asked = vec(unit(points - apex), np.float64), np.arange(COUNT) % 3 == 0
    given = packed(corners, normal), vec(apex, np.float64)
    assert np.array_equal(may_meet(*given, None, direction, asked), asked)
