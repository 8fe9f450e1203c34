"""Rays from points on a surface or within 1e-9 of it, rays at the rims of small shapes far away, and rays sent on from
hits: how exact they are, and whether they hit the surface again that they leave."""

from __future__ import annotations

import random as system_random
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import pytest

from minirt.shapes import KINDS, Cone, Cylinder, Disc, Ellipsoid, Hyperboloid, Paraboloid, Shape, quadrics
from tests.oracle.body import body, crossings
from tests.shapes.examples import example, place
from tests.shapes.execution_modes import Intersect, on_arrays
from tests.shapes.regimes import GREY, RAYS, Array, Random, Rays, log_uniform, random_directions, unit
from tests.shapes.regimes import random_perpendiculars as perpendiculars
from tests.stability import revolved, sheets
from tests.stability.common import Make, Shots, interpreted, nearest_on_surface, pose_of, shots, sign, traced, within
from tests.stability.degenerate import wrong_of
from tests.stability.mutants import as_of_a_shadow_ray, with_ends_beside_the_start
from tests.stability.regime import BOUND, U, certified, size

STEEP = 2.0**-16  # cosine of ray and normal: a ray that starts on a surface and is flatter touches it, to rounding
AGAIN = 64.0  # roundings of the start's height above the surface, within which a hit is that of the start
SEED = system_random.SystemRandom().randrange(2**32)  # each run tries other rays


class Case(NamedTuple):
    """A recipe for shapes and for rays at them."""

    name: str
    make: Make
    rays: Shots
    sent_on: bool = False  # whether the rays are sent on from where they hit, and these are judged


class Row(NamedTuple):
    """Counts and the largest error of the hits of a case, and a complaint about the first wrong one."""

    hits: int
    largest: float  # backward error
    above: int  # hits whose backward error is above the bound
    again: int  # hits of the surface that the ray has just left
    wrong: int  # answers that are right for no shape within 64 roundings
    complaint: str = ""


def measured(case: Case, seed: int, shapes: int) -> Row:
    """Trace the rays of a case, and judge what they meet."""
    rays = shots(seed, case.make, case.rays, shapes)
    before = np.full(rays.origins.shape, np.nan)  # normals of the surfaces that are left
    if case.sent_on:
        distances, points, before = traced(rays)
        starts = np.where(np.isfinite(distances)[..., None], points, rays.origins)
        random = np.random.default_rng(seed)
        ways = [onward(random, each, within(shape, random)) for shape, each in zip(rays.shapes, starts, strict=True)]
        for shape, way in zip(rays.shapes, ways, strict=True):
            way[0] = getattr(shape, "axis", way[0])  # one ray exactly along the axis
        rays = Rays(rays.shapes, starts, np.stack(ways))
    t, _, normals = traced(rays)
    found = certified(rays, t, normals)
    errors, slope = np.nan_to_num(found.backward_error), np.abs((before * rays.directions).sum(axis=-1))
    along = np.abs((normals * rays.directions).sum(axis=-1))
    same = (normals * before).sum(axis=-1) > 0.5
    with np.errstate(invalid="ignore"):
        magnitude = found.condition * t * along  # t, the way to the shape and its size
        again = same & (slope > STEEP) & (t * slope <= AGAIN * U * magnitude)
    for i, j in np.argwhere(again):
        again[i, j] = is_start(t[i, j], rays.shapes[i], rays.origins[i, j], rays.directions[i, j])
    wrong = [str(each) for each in wrong_of(rays, t)]
    for i, j in np.argwhere((errors > BOUND) | again):
        wrong.append(f"error {errors[i, j]}: {rays.shapes[i]} from {rays.origins[i, j]}, {rays.directions[i, j]}")
    hits, above = np.isfinite(t).sum(), (errors > BOUND).sum()
    count = len(wrong) - ((errors > BOUND) | again).sum()
    return Row(int(hits), float(errors.max()), int(above), int(again.sum()), int(count), *wrong[:1])


def is_start(t: float, shape: Shape, origin: Array, direction: Array) -> bool:
    """Whether a ray meets the shape at t only if at all where it starts: a short chord is no such hit."""
    exact = sorted(crossings(body(shape), list(origin), list(direction)), key=abs)
    return not any(abs(other - t) <= t / 1000 for other in exact[1:])


def onward(random: Random, starts: Array, targets: Array) -> Array:
    """Directions from points of a shape: anywhere, and half of them at targets."""
    anywhere = random_directions(random, len(starts))
    return np.where(random.random((len(starts), 1)) < 0.5, anywhere, unit(targets - starts))


def hyperboloid(random: Random, waist: float) -> Hyperboloid:
    widest, height = random.uniform(0.5, 2, 2)
    return Hyperboloid(*pose_of(random), waist * widest, widest, height, GREY)


def needle(random: Random, thin: float) -> Ellipsoid:
    sizes = random.permutation([1.0, *(thin * random.uniform(0.5, 2, 2))])
    return Ellipsoid(*pose_of(random), tuple(random.uniform(0.5, 2) * sizes), GREY, roll=random.uniform(0, 360))


def side_of(random: Random, shape: Hyperboloid) -> Array:
    """Points of the side of a hyperboloid, half of them at heights down to those of its waist."""
    share = np.where(np.arange(RAYS)[:, None] % 2, random.random((RAYS, 1)), log_uniform(random, 1e-9, 1, RAYS, 1))
    radius, axis = np.hypot(shape.waist, share * np.sqrt(shape.diameter**2 - shape.waist**2)) / 2, np.array(shape.axis)
    up = share * shape.height / 2 * sign(random)
    return np.asarray(shape.centre + up * axis + radius * perpendiculars(random, axis, RAYS))


def skin_of(random: Random, shape: Ellipsoid) -> Array:
    """Points of an ellipsoid, half of them near the tips."""
    on = random_directions(random, RAYS)
    on[::2] *= log_uniform(random, 1e-4, 1, RAYS // 2, 3)
    z, x, y = shape.frame()
    return np.asarray(shape.centre + (np.array(shape.sizes) / 2 * unit(on)) @ [[v.x, v.y, v.z] for v in (x, y, z)])


def beside(spots: Callable[[Random, Any], Array], random: Random, shape: Any) -> tuple[Array, Array]:
    """Rays from points of the surface, rounded; half of them from up to 1e-9 sizes above or below it."""
    on = np.array([nearest_on_surface(shape, point) for point in spots(random, shape)])
    off = size(shape) * log_uniform(random, 1e-17, 1e-9, RAYS, 1) * random_directions(random, RAYS)
    starts = np.where(np.arange(RAYS)[:, None] % 4 < 2, on, on + off)
    return starts, onward(random, starts, spots(random, shape))


def aimed(random: Random, shape: Shape) -> tuple[Array, Array]:
    """Rays from up to ten sizes away at points within a shape."""
    origins = place(shape) + size(shape) * log_uniform(random, 0.1, 10, RAYS, 1) * random_directions(random, RAYS)
    return origins, unit(within(shape, random) - origins)


def at_edges(random: Random, shape: Any) -> tuple[Array, Array]:
    """Rays at the edges of a triangle, off them by roundings, also at small slopes to it."""
    target = sheets.edge(random, shape) + log_uniform(random, 1e-18, 1e-12, RAYS, 1) * random_directions(random, RAYS)
    slope, normal = log_uniform(random, 1e-9, 1, RAYS, 1) * sign(random), np.array(shape.normal())
    directions = unit(perpendiculars(random, normal, RAYS) + slope * normal)
    return target - log_uniform(random, 0.01, 10, RAYS, 1) * directions, directions


def at_rims(distance: float, random: Random, shape: Any) -> tuple[Array, Array]:
    """Rays from so far away at the rim of a shape."""
    target = (sheets if isinstance(shape, Disc) else revolved).rim(random, shape)
    target = target + size(shape) * log_uniform(random, 1e-17, 1e-3, RAYS, 1) * random_directions(random, RAYS)
    origins = target + distance * random.uniform(0.5, 1, (RAYS, 1)) * random_directions(random, RAYS)
    return origins, unit(target - origins)


def thin(random: Random, least: float) -> float:
    """A ratio from `least` to 0.1."""
    return float(log_uniform(random, least, 0.1))


SENT_ON: dict[str, Make] = {
    **{
        kind.element.title: partial(example, kind) for kind in KINDS if kind.element.solid and not kind.element.infinite
    },
    "flat cylinder": lambda random: Cylinder(*pose_of(random), 1, thin(random, 1e-9), GREY),
    "thin cylinder": lambda random: Cylinder(*pose_of(random), thin(random, 1e-9), 1, GREY),
    "thin cone": lambda random: Cone(*pose_of(random), thin(random, 1e-6), 1, GREY),
    "blunt cone": lambda random: Cone(*pose_of(random), 1, thin(random, 1e-6), GREY),
    "hyperboloid with a thin waist": lambda random: hyperboloid(random, thin(random, 1e-8)),
    "ellipsoid needle": lambda random: needle(random, thin(random, 1e-6)),
}


def cases() -> Iterator[Case]:
    for ratio in (1e-2, 1e-4, 1e-8):
        name = f"hyperboloid with a waist of {ratio:g}, from its side"
        yield Case(name, partial(hyperboloid, waist=ratio), partial(beside, side_of))
    for ratio in (1e-2, 1e-4, 1e-6):
        name = f"ellipsoid needle of 1:{1 / ratio:g}, from its surface"
        yield Case(name, partial(needle, thin=ratio), partial(beside, skin_of))
    for height in (1.0, 1e-3, 1e-6):
        yield Case(f"triangle {height:g} high, at its edges", partial(sheets.triangle, height=height), at_edges)
    for kind in (kind for kind in KINDS if kind.element in (Disc, Cylinder, Cone, Paraboloid, Hyperboloid)):
        for scale, offset, distance in ((1e-8, 4.0, 1e-7), (1e-8, 4.0, 4.0), (1.0, 1e12, 10.0), (1.0, 1e12, 1e12)):
            name = f"{kind.element.title} {scale:g} across at {offset:g}, rim seen from {distance:g}"
            yield Case(name, partial(example, kind, size=scale, offset=offset), partial(at_rims, distance))
    for title, make in SENT_ON.items():
        yield Case(f"{title}, from points that were hit", make, aimed, sent_on=True)


CASES = list(cases())


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_rays_that_start_close_are_exact_and_leave_their_surface(case: Case) -> None:
    row = measured(case, SEED, 16)
    assert row.hits > 50, SEED
    assert row[2:] == (0, 0, 0, ""), (SEED, row)


PLANTED = {
    "hyperboloid with a waist of 0.01, from its side": as_of_a_shadow_ray,
    "cylinder, from points that were hit": as_of_a_shadow_ray,
    "cone, from points that were hit": with_ends_beside_the_start,
}


@pytest.mark.parametrize("case", [case for case in CASES if case.name in PLANTED], ids=lambda case: case.name)
def test_a_careless_formula_does_not_pass(case: Case, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(f"{__name__}.traced", partial(interpreted, intersect=PLANTED[case.name]))
    assert measured(case, SEED, 16)[2:5] != (0, 0, 0)


FLAT: dict[str, Callable[[Random, float], Shape]] = {
    "cylinder": lambda random, thickness: Cylinder(*pose_of(random), 1, thickness, GREY),
    "cone": lambda random, thickness: Cone(*pose_of(random), 1, thickness, GREY),
    "paraboloid": lambda random, thickness: Paraboloid(*pose_of(random), 1, thickness, GREY),
    "hyperboloid": lambda random, thickness: Hyperboloid(*pose_of(random), 0.5, 1, thickness, GREY),
}


def holes(title: str, intersect: Intersect) -> int:
    """The number of rays that miss the middles of solids thinner than the rounding of the rays' coordinates."""
    random, missed = np.random.default_rng(SEED), 0
    for thickness, distance in ((1e-9, 1e7), (1e-12, 1e5), (1e-14, 30.0)) * 20:
        shape: Any = FLAT[title](random, thickness)
        aside = random.uniform(0, 0.2, (RAYS, 1)) * perpendiculars(random, np.array(shape.axis), RAYS)
        origins = place(shape) + aside + distance * random_directions(random, RAYS)
        t = intersect([shape], origins[None], unit(place(shape) + aside - origins)[None])
        missed += int(np.isinf(t).sum())
    return missed


@pytest.mark.parametrize("intersect", [on_arrays, as_of_a_shadow_ray])
@pytest.mark.parametrize("title", FLAT)
def test_flat_solids_have_no_holes(title: str, intersect: Intersect) -> None:
    assert holes(title, intersect) == 0, SEED


def test_a_flat_paraboloid_whose_intervals_must_overlap_has_holes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(quadrics, "BESIDE", 0.0)
    assert holes("paraboloid", on_arrays) > 0
