"""Rays that start on a surface as `minirt.kernel.shading.shade` starts them do not hit it again, and do not leave a
solid; flat solids have no holes; and the length of a direction does not matter."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

import minirt
from minirt.scene import Scene
from minirt.shapes import (
    KINDS,
    Box,
    Cone,
    Cylinder,
    Disc,
    Hyperboloid,
    Kind,
    Paraboloid,
    Shape,
    Sphere,
    Square,
    Torus,
    quadrics,
)
from tests import oracle
from tests.seeds import RUN
from tests.shapes.examples import place, shadow_offsets
from tests.shapes.execution_modes import Intersect, on_arrays
from tests.shapes.regimes import GREY, RAYS, Array, Random, log_uniform, random_directions, random_perpendiculars, unit
from tests.stability.mutants import as_of_a_shadow_ray
from tests.stability.rays import Pose, pose, rays
from tests.stability.test_exact import EYE, KIND, struck
from tests.stability.verdicts import BOUND, off

SHAPES, DIRECTIONS = 40, 256
DEEP = 0.5  # of the offset: the least depth of a start in a solid that no ray leaves unseen
ANYWHERE = Pose((1e-8, 1e8), (1.0, 1e8), (0.1, 10.0))
Offset = Callable[[Array, list[Shape]], Array]


def away_from(random: Random, normals: Array) -> Array:
    """Directions away from a surface: half of them anywhere, half of them grazing it, to a cosine of 1e-8."""
    n = len(normals)
    low = random.random((n, 1)) < 0.5
    cosine = np.where(low, log_uniform(random, 1e-8, 1e-2, n, 1), random.uniform(0.01, 1, (n, 1)))
    return unit(cosine * normals + np.sqrt(1 - cosine**2) * random_perpendiculars(random, normals, n))


@cache
def hit_points(kind: Kind, drawn: Pose, shapes: int) -> list[tuple[Shape, Array, Array]]:
    """Shapes of a kind, points of each that rays hit, and the outward normals there, (DIRECTIONS, 3) each."""
    random, found = np.random.default_rng(RUN), []
    for _ in range(shapes):
        with np.errstate(all="ignore"):
            shape = pose(kind, random, drawn)
            origins, directions = rays(shape, random, DIRECTIONS)
            points, normals = struck(shape, origins, directions)
        if points is not origins:
            found.append((shape, np.resize(points, (DIRECTIONS, 3)), np.resize(normals, (DIRECTIONS, 3))))
    return found


def sent(
    kind: Kind,
    offset: Offset,
    *modes: Intersect,
    side: float = 1.0,
    drawn: Pose = ANYWHERE,
    shapes: int = SHAPES,
) -> tuple[int, int]:
    """The numbers of rays from points that were hit, to the outer side or to the inner one, that hit where there is
    nothing to hit (shadow acne), and that leave a solid unseen."""
    random, acne, leaks = np.random.default_rng(RUN), 0, 0
    for shape, points, normals in hit_points(kind, drawn, shapes):
        out = side * normals
        apart = offset(points[None], [shape])[0]
        starts, ways = points + apart * out, away_from(random, out)
        answers = np.stack([intersect([shape], starts[None], ways[None])[0] for intersect in modes])
        hit = np.isfinite(answers)
        if oracle.is_sheet(shape):
            acne += int(hit.sum())
            continue
        ray = oracle.Crossed(shape, starts, ways)
        deep = ray.heights(np.zeros(len(ways))).above < -DEEP * apart[:, 0]  # not beside a rim, nearer to another face
        leaks += int((~hit & deep).sum())
        if hit.any():
            cuts, above, _ = ray.pieces(np.zeros(len(ways)))
            for t in answers:
                real = ((above < -2 * apart[:, 0]) & (cuts[:-1] <= 10 * t)).any(axis=0)
                acne += int((np.isfinite(t) & ~real).sum())
    return acne, leaks


@KIND
def test_no_ray_hits_the_surface_again_from_which_it_starts(kind: Kind) -> None:
    assert sent(kind, shadow_offsets, on_arrays, as_of_a_shadow_ray)[0] == 0, RUN


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind.element.solid and not kind.element.infinite])
def test_no_ray_leaves_a_solid_unseen(kind: Kind) -> None:
    assert sent(kind, shadow_offsets, on_arrays, side=-1.0)[1] == 0, RUN


def fixed(points: Array, shapes: list[Shape]) -> Array:
    return np.full((*points.shape[:2], 1), 1e-4)


def none(points: Array, shapes: list[Shape]) -> Array:
    return np.zeros((*points.shape[:2], 1))


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind.element not in (Sphere, Torus, Box, Disc, Square)])
def test_other_offsets_do_not_pass(kind: Kind) -> None:
    """The kinds that are left out are hit by no ray where it starts."""
    assert sent(kind, none, as_of_a_shadow_ray)[0] > 20
    far = Pose((1e13, 1e13), (1.0, 1.0), (1.0, 1.0))
    assert sent(kind, fixed, as_of_a_shadow_ray, drawn=far, shapes=10)[0] > 20


FLAT: dict[str, Callable[[Random, float], Shape]] = {
    "cylinder": lambda random, thin: Cylinder(*posed(random), 1, thin, GREY),
    "cone": lambda random, thin: Cone(*posed(random), 1, thin, GREY),
    "paraboloid": lambda random, thin: Paraboloid(*posed(random), 1, thin, GREY),
    "hyperboloid": lambda random, thin: Hyperboloid(*posed(random), 0.5, 1, thin, GREY),
}


def posed(random: Random) -> tuple[tuple[float, ...], tuple[float, ...]]:
    return tuple(random.normal(size=3)), tuple(random_directions(random).clip(-1, 1))


def holes(title: str, intersect: Intersect) -> int:
    """The number of rays that miss the middles of solids thinner than the rounding of the rays' coordinates."""
    random, missed = np.random.default_rng(RUN), 0
    for thickness, far in ((1e-9, 1e7), (1e-12, 1e5), (1e-14, 30.0)) * 20:
        shape = FLAT[title](random, thickness)
        axis = np.array(shape.axis)  # type: ignore[attr-defined]
        aside = random.uniform(0, 0.2, (RAYS, 1)) * random_perpendiculars(random, axis, RAYS)
        origins = place(shape) + aside + far * random_directions(random, RAYS)
        t = intersect([shape], origins[None], unit(place(shape) + aside - origins)[None])
        missed += int(np.isinf(t).sum())
    return missed


@pytest.mark.parametrize("intersect", [on_arrays, as_of_a_shadow_ray])
@pytest.mark.parametrize("title", FLAT)
def test_flat_solids_have_no_holes(title: str, intersect: Intersect) -> None:
    assert holes(title, intersect) == 0, RUN


def test_a_flat_paraboloid_whose_intervals_must_overlap_has_holes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(quadrics, "BESIDE", 0.0)
    assert holes("paraboloid", on_arrays) > 0


def test_a_ray_leaves_a_sphere_of_hardly_more_than_the_rounding_of_its_place() -> None:
    """Coordinates there are 1.2e-4 apart, an eighth of the radius."""
    far = Sphere((-68368846870, -174649699512.5, -618464938073.5), 0.0018690041051300042, GREY)
    start = np.array([[-68368846869.999405, -174649699512.50034, -618464938073.5006]])
    leaving = np.array([[0.3292206323176564, 0.4573309292429209, -0.8261127020051011]])
    assert on_arrays([far], start[None], leaving[None])[0, 0] == np.inf
    through = on_arrays([far], start[None], -leaving[None])[0, 0]
    assert through == pytest.approx(oracle.nearest(far, start[0], -leaving[0]), rel=0.1)  # of a blurred start


def test_a_steep_ray_from_a_rim_hits_the_other_side() -> None:
    """It starts 1e-17 above the end and 2e-9 above the side, where coordinates are 1.5e-8 apart."""
    tower = Hyperboloid((123346876, -23277840, 47204889), (0, 0.8, 0.6), 1.25, 2.5, 5, GREY)
    start = np.array([[123346877.22273652, -23277837.844213143, 47204890.29228419]])
    inwards = np.array([[-0.3008411937223423, -0.8852722804569826, -0.35466542771210385]])
    found = on_arrays([tower], start[None], inwards[None])[0]
    assert off(tower, start, inwards, found).max() <= BOUND
    assert found[0] == pytest.approx(5.42878097)


@KIND
def test_the_length_of_a_direction_does_not_matter(kind: Kind) -> None:
    random = np.random.default_rng(RUN)
    for power in random.integers(-1000, 1000, 20):
        shape = pose(kind, random)
        origins, directions = rays(shape, random, RAYS)
        scene, scale = Scene((EYE, shape)), 2.0 ** int(power)
        kept = (scale * directions / scale == directions).all(axis=1)  # other products have lost bits by underflow
        origins, directions = origins[kept], directions[kept]
        one, other = (minirt.trace(scene, origins, factor * directions) for factor in (1.0, scale))
        assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip(one, other, strict=True)), (RUN, power)
