"""The triangle's formulas, against answers known by hand; rays that are hard for them are in `tests.stability`."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from itertools import permutations

import numpy as np
import pytest

from minirt.errors import ElementError
from minirt.shapes.triangle import Triangle, plane_normals
from tests.oracle.body import cross
from tests.shapes.execution_modes import Intersect, U, shoot
from tests.shapes.regimes import GREY, RAYS, Array, Random, log_uniform, random_directions, unit
from tests.stability.mutants import in_single_precision

SAIL = Triangle((-2, 0, 5), (2, 0, 5), (0, 3, 8), GREY)


def test_answers_known_by_hand(intersect: Intersect) -> None:
    rays = [
        ((0, 1, 0), (0, 0, 1)),  # z = 5 + y
        ((0, 1, 0), (0, 0, -1)),  # behind
        ((0, 2, 9), (0, 0, -1)),  # from its back
        ((0, 9, 6), (0, -1, 0)),  # from above, at y = 1
        ((-9, 1.5, 6.5), (1, 0, 0)),  # along its lines, in it
        ((1.3, 1, 0), (0, 0, 1)),  # 1 / 30 within the edge, at y = 1
        ((1.4, 1, 0), (0, 0, 1)),  # and past it
        ((-1.3, 1, 0), (0, 0, 1)),
        ((-1.4, 1, 0), (0, 0, 1)),
        ((0, -0.01, 0), (0, 0, 1)),
        ((0, 3.01, 0), (0, 0, 1)),
        ((0, 1, 6), (0, 0, 1)),  # from it
        ((0, 1, 2), (0, 0.6, 0.8)),  # y + 5 = z: 0.2 t = 4
    ]
    expected = [6, np.inf, 2, 8, np.inf, 6, np.inf, 6, np.inf, np.inf, np.inf, np.inf, np.inf]
    for corners in permutations((SAIL.a, SAIL.b, SAIL.c)):
        t = shoot(intersect, Triangle(*corners, GREY), *rays)
        assert t[:4] + t[5:] == pytest.approx(expected[:4] + expected[5:], rel=1e-15)


@pytest.mark.parametrize("turn", range(3))
@pytest.mark.parametrize("sign", [1, -1])
def test_it_is_hit_along_every_axis(intersect: Intersect, turn: int, sign: int) -> None:
    def turned(p: tuple[float, ...]) -> tuple[float, ...]:
        return tuple(np.roll(np.array(p) * [1, 1, sign], turn))

    other = Triangle(turned(SAIL.a), turned(SAIL.b), turned(SAIL.c), GREY)
    rays = [((0.3, 0.1, 0), (-0.05, 0.1, 0.9)), ((0.3, 0.5, 9), (0.1, 0.2, -0.9)), ((0.3, 1, 0), (-0.5, 0.2, 0.9))]
    rays += [((0.3, 1, 9), (0, 0, -1)), ((0.3, 1, 0), (0, 0, 1))]
    plain = shoot(intersect, SAIL, *rays)
    assert np.isfinite(plain).tolist() == [True, True, False, True, True]
    assert shoot(intersect, other, *[(turned(o), turned(d)) for o, d in rays]) == pytest.approx(plain, rel=4e-16)


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
        exact = cross(to_b, to_c)
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
