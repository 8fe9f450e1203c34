"""Which answers for a ray are right: those that are exact for a ray and a shape within 64 roundings of the given ones.

A rounding is 2^-53 of the sum of t, of the distance from the ray's origin to the shape, and of the shape's size. The
shape thicker by 64 roundings and the one thinner by them enclose a shell. A hit is right if it lies in the shell and
the ray neither enters the thinner solid nor leaves the thicker one before. A miss is right if the ray never does one of
the two.

One more thing is asked of a ray that starts in the shell, such as one that starts exactly on the surface: it has no hit
before it leaves the shell, unless the exact answer has one. Else the eye would see the place on which it lies.

A sheet has no inside: a hit is right if it is within 64 roundings of its plane and of its edges, and a miss if a ray so
close to the given one passes beside it. A plane, which has no size, may be hit at a ray's start: rounding takes the eye
to one of its sides, for all rays alike.

The facts come for many rays at once from `tests.oracle.many`, or one by one in 60 digits.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from gmpy2 import mpfr

from minirt.scene.writer import line_of
from minirt.shapes import Kind, Shape
from tests import oracle
from tests.oracle.body import body, inside, meetings
from tests.oracle.many import crossed
from tests.shapes.execution_modes import Intersect
from tests.shapes.regimes import Array, Rays
from tests.stability.places import pose, snapped
from tests.stability.regime import BOUND, Regime, U, away_from_surface, points, rays_of, size

SLACK = 64.0
START = 16.0  # roundings of the largest coordinate of an origin, by which it may be on a surface
STEEP = 2.0**-16  # slope of a ray to the surface: one that starts there and is flatter touches it, to rounding
Mask = np.ndarray


class Facts(NamedTuple):
    """Facts about n rays, of solids and of sheets."""

    exact: Array  # the nearest hits, infinity where there is none
    thicker: Array  # of a sheet: where the ray leaves the band of its plane
    thinner: Array
    starts_in_thicker: Mask  # of a sheet: in the band of its plane
    starts_in_thinner: Mask  # of a sheet: false
    in_shell: Mask  # the point at t
    band: Array  # the 64 roundings
    wider: Array  # the nearest hits, also of walls beyond edges that are within the band


def right(shape: Shape, directions: Array, t: Array, facts: Facts) -> Mask:
    """Which of the answers t, infinity for a miss, are right."""
    found = np.where(np.isfinite(t), (t > 0) & facts.in_shell & ~again(shape, t, facts), np.isposinf(t))
    if not body(shape).solid:
        slope = np.abs(directions @ np.array([float(x) for x in oracle.normal(shape, points(shape)[0])]))
        missed = np.isinf(facts.exact) | np.isinf(facts.thinner) | facts.starts_in_thicker | (slope <= SLACK * U)
        return found & (np.isfinite(t) | missed)
    enters, leaves = until(facts)
    reached = np.maximum(enters, leaves) * (1 + 8 * U)
    return found & np.where(np.isfinite(t), t <= reached, np.isinf(reached))


def surely_wrong(shape: Shape, origins: Array, directions: Array, t: Array) -> tuple[Mask, Facts]:
    """Which of the answers t are wrong to 60 digits, and the facts.

    A ray that starts within the roundings of its origin's coordinates of the surface may be taken for one that starts
    on it, or on the other side.
    """
    facts = facts_of_each(shape, origins, directions, t)
    wrong = ~right(shape, directions, t, facts)
    for i in np.flatnonzero(wrong & ~again(shape, t, facts)):
        ray = shape, origins[i : i + 1], directions[i : i + 1], t[i : i + 1]
        wider = facts_of_each(*ray, START)
        wrong[i] = not (wider.starts_in_thicker & ~wider.starts_in_thinner & right(shape, *ray[2:], wider)).all()
    return wrong, facts


def again(shape: Shape, t: Array, facts: Facts) -> Mask:
    """Which hits t are those of the surface from which the ray starts, where there is none.

    Not asked of rays that stay in the shell for longer, as they touch the surface.
    """
    enters, leaves = until(facts)
    first = np.minimum(enters, leaves)
    start = facts.starts_in_thicker & ~facts.starts_in_thinner
    found: Mask = start & (t <= first) & ~(facts.wider <= first) & (STEEP * first <= facts.band) & (size(shape) > 0)
    return found


def until(facts: Facts) -> tuple[Array, Array]:
    """Where a ray enters the thinner solid, and where it leaves the thicker one; 0 if it is there, or beyond."""
    return (
        np.where(facts.starts_in_thinner, 0.0, facts.thinner),
        np.where(facts.starts_in_thicker, facts.thicker, 0.0),
    )


def swell(shape: Shape, origins: Array, t: Array, exact: Array) -> Array:
    """64 roundings for each ray."""
    far = np.where(np.isfinite(t), t, np.where(np.isfinite(exact), exact, 0.0))
    return np.asarray(SLACK * U * (far + away(shape, origins) + size(shape)))


def away(shape: Shape, origins: Array) -> Array:
    """The distances of origins from the first point that a shape is given by."""
    return np.linalg.norm(origins - points(shape)[0], axis=-1)


def facts_of_many(shape: Shape, origins: Array, directions: Array, t: Array) -> Facts:
    """The facts of rays (n, 3), to about 30 digits."""
    plain = crossed(shape, origins, directions)
    exact = plain.nearest()
    band, zero, at = swell(shape, origins, t, exact), np.zeros(t.shape), np.where(np.isfinite(t), t, 0.0)
    thicker, thinner = (crossed(shape, origins, directions, sign * band) for sign in (1, -1))
    if plain.solid:
        starts = thicker.inside(zero), thinner.inside(zero)
        in_shell = thicker.inside(at) & ~thinner.inside(at)
    else:
        starts = np.abs(plain.height(zero)) <= band, np.zeros(t.shape, bool)
        in_shell = (np.abs(plain.height(at)) <= band) & thicker.within(at)
        play = band / np.abs(plain.walls[0].coefficients[1].high)
        surely = np.logical_and.reduce([thinner.within(exact + side * play) for side in (-1, 0, 1)])
        leaves, sure = np.where(starts[0], 2 * play, 0.0), np.where(surely, exact, np.inf)
        return Facts(exact, leaves, sure, *starts, in_shell, band, thicker.nearest())
    return Facts(exact, thicker.nearest(), thinner.nearest(), *starts, in_shell, band, exact)


def facts_of_each(shape: Shape, origins: Array, directions: Array, t: Array, roundings: float = 0.0) -> Facts:
    """The same, each ray on its own in 60 digits: slow. The band is at least as wide as these `roundings` of the
    origin's largest coordinate."""
    answers = [facts_of_one(shape, *ray, roundings) for ray in zip(origins, directions, t, strict=True)]
    return Facts(*(np.array(column) for column in zip(*answers, strict=True)))


def facts_of_one(shape: Shape, origin: Array, direction: Array, t: float, roundings: float) -> Facts:
    def nearest(by: mpfr) -> float:
        found = oracle.nearest(shape, origin, direction, by)
        return np.inf if found is None else float(found)

    exact = nearest(mpfr(0))
    band = mpfr(float(swell(shape, origin[None], np.array([t]), np.array([exact]))[0]))
    band = max(band, mpfr(roundings * U * np.abs(origin).max()))
    at = [mpfr(o) + mpfr(t if np.isfinite(t) else 0.0) * mpfr(d) for o, d in zip(origin, direction, strict=True)]
    thicker, thinner = body(shape, band), body(shape, -band)
    if thicker.solid:
        starts = inside(thicker, list(origin)), inside(thinner, list(origin))
        in_shell = inside(thicker, at) and not inside(thinner, at)
    else:
        wall = thicker.walls[0]
        start, slope = wall(oracle.exact(origin)), abs(oracle.dot(oracle.normal(shape, origin), direction))
        play = band / slope if slope else mpfr("inf")
        starts = abs(start) <= band, False
        in_shell = abs(wall(at)) <= band and all(clip(at) <= 0 for clip in thicker.clips)
        ends = [oracle.exact(origin + (exact + side * float(play)) * direction) for side in (-1, 0, 1)]
        surely = np.isfinite(exact) and all(clip(end) <= 0 for end in ends for clip in thinner.clips)
        sure = exact if surely else np.inf
        return Facts(*map(np.array, (exact, float(2 * play), sure, *starts, in_shell, float(band), nearest(band))))
    near = any(abs(root - t) <= t / 2 for root in meetings(body(shape), list(origin), list(direction)))
    wider = t if in_shell and near else exact
    return Facts(*map(np.array, (exact, nearest(band), nearest(-band), *starts, in_shell, float(band), wider)))


class Wrong(NamedTuple):
    """A ray with a wrong answer."""

    shape: Shape
    origin: list[float]
    direction: list[float]
    t: float
    exact: float
    again: bool  # whether it is the hit of the surface from which the ray starts

    def __str__(self) -> str:
        reason = " (where it starts)" if self.again else ""
        line = line_of(self.shape)
        return f"t = {self.t!r}{reason}, not {self.exact!r}: {line} from {self.origin} along {self.direction}"


def groups(kind: Kind, seed: int, shapes: int, rays: int) -> Iterator[tuple[Shape, Array, Array]]:
    """Shapes of a kind in random poses, and for each its snapped rays."""
    random = np.random.default_rng(seed)
    for _ in range(shapes):
        shape = pose(kind, random)
        with np.errstate(all="ignore"):
            yield shape, *snapped(shape, random, rays)


def wrong(
    intersect: Intersect, shape: Shape, origins: Array, directions: Array, most: int | None = None
) -> list[Wrong]:
    """The rays of a shape whose answer is wrong."""
    return judged(shape, origins, directions, intersect([shape], origins[None], directions[None])[0], most)


def wrong_of(rays: Rays, *answers: Array, most: int | None = None) -> list[Wrong]:
    """The rays to which one of several answers t, (m, n) each, is wrong, of each shape at most so many."""
    parts = [rays.origins, rays.directions, *answers]
    found = []
    for i, shape in enumerate(rays.shapes):
        origins, directions, *ts = (part[i] for part in parts)
        given = (np.tile(part, (len(ts), 1)) for part in (origins, directions))
        found += judged(shape, *given, np.concatenate(ts), most)
    return found


def wrong_in(regime: Regime, *answers: Array, most: int | None = None) -> list[str]:
    """Complaints about several answers t to the rays of a regime, judged at once; see `wrong_of`. A sheet holds the
    backward bound without its size."""
    rays, t = rays_of(regime), np.concatenate(answers, axis=1)
    rays = Rays(rays.shapes, *(np.tile(part, (1, len(answers), 1)) for part in rays[1:]))
    found = [*map(str, wrong_of(rays, t, most=most)), *away_from_surface(rays, t)]
    for i, (shape, origins, directions) in enumerate(zip(*rays, strict=True)):
        ray = crossed(shape, origins, directions)
        with np.errstate(all="ignore"):
            exact, far = ray.nearest(), t[i] < regime.nearest * size(shape)
            if not ray.solid:
                far |= np.abs(ray.height(t[i])) > BOUND * U * (t[i] + away(shape, origins))
            if regime.tolerance is not None:
                far |= ~((t[i] == exact) | (np.abs(t[i] - exact) <= regime.tolerance * exact))
        found += [f"t = {t[i, j]!r}, not {exact[j]!r}: {shape} from {origins[j]}" for j in np.flatnonzero(far)]
    return found


def judged(shape: Shape, origins: Array, directions: Array, t: Array, most: int | None = None) -> list[Wrong]:
    """The wrong ones of answers t; of those that seem wrong only so many are judged in 60 digits."""
    with np.errstate(all="ignore"):
        facts = facts_of_many(shape, origins, directions, t)
        seem = np.flatnonzero(~right(shape, directions, t, facts))[:most]
        if not seem.size:
            return []
        o, d, t = origins[seem], directions[seem], t[seem]
        sure, exact = surely_wrong(shape, o, d, t)
        start = again(shape, t, exact)
    return [
        Wrong(shape, o[i].tolist(), d[i].tolist(), float(t[i]), float(exact.exact[i]), bool(start[i]))
        for i in np.flatnonzero(sure)
    ]
