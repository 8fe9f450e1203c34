"""Which answers for a ray are right: those that are exact for a ray and a shape within 64 roundings of the given ones.

A rounding is 2^-53 of the sum of t, of the distance from the ray's origin to the shape, and of the shape's size. The
shape thicker by 64 roundings and the one thinner by them enclose a shell. A hit is right if it lies in the shell and
the ray neither enters the thinner solid nor leaves the thicker one before. A miss is right if the ray does neither at
all. One more thing is asked of a ray that starts in the shell, such as one that starts exactly on the surface: it has no
hit before it leaves the shell, unless the exact answer has one. Else the surface would shadow itself.

A sheet has no inside: a hit is right if it is within 64 roundings of its plane and of its edges.

The facts come for many rays at once from `tests.oracle.many`, or one by one in 60 digits.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from gmpy2 import mpfr

from minirt.shapes import Shape
from tests import oracle
from tests.oracle.body import body, inside
from tests.oracle.many import crossed
from tests.shapes.regimes import Array
from tests.stability.regime import U, lever, points, size

SLACK = 64.0
NEAR = 2.0**-13  # of the size: a hit farther away is not that of the start, even along the surface
Mask = np.ndarray


class Facts(NamedTuple):
    """What is true of n rays, of solids and of sheets."""

    exact: Array  # the nearest hits, infinity where there is none
    thicker: Array
    thinner: Array
    starts_in_thicker: Mask  # of a sheet: within the band of its plane
    starts_in_thinner: Mask  # of a sheet: false
    in_shell: Mask  # the point at t


def right(shape: Shape, directions: Array, t: Array, facts: Facts) -> Mask:
    """Which of the answers t, infinity for a miss, are right."""
    near = t <= NEAR * scale(shape, t)
    hit = np.isfinite(t)
    if body(shape).solid:
        enters = np.where(facts.starts_in_thinner, 0.0, facts.thinner)  # the thinner solid
        leaves = np.where(facts.starts_in_thicker, facts.thicker, 0.0)  # the thicker one
        reached = np.maximum(enters, leaves) * (1 + 8 * U)
        missed = np.isinf(enters) | np.isinf(leaves)
        start = facts.starts_in_thicker & ~facts.starts_in_thinner & (t <= enters) & (t <= leaves)
        again = start & near & ~(facts.exact <= np.minimum(enters, leaves))
    else:
        slope = np.abs(directions @ np.array([float(x) for x in oracle.normal(shape, points(shape)[0])]))
        reached = np.full(t.shape, np.inf)
        missed = np.isinf(facts.exact) | np.isinf(facts.thinner) | facts.starts_in_thicker | (slope <= SLACK * U)
        again = facts.starts_in_thicker & near & ~(facts.exact <= NEAR * scale(shape, t))
    return np.where(hit, (t > 0) & facts.in_shell & (t <= reached) & ~again, np.isposinf(t) & missed)


def scale(shape: Shape, t: Array) -> Array:
    """The size of a shape; a plane has none."""
    return np.full(t.shape, size(shape) or 1.0)


def swell(shape: Shape, origins: Array, t: Array, exact: Array) -> Array:
    """64 roundings for each ray."""
    far = np.where(np.isfinite(t), t, np.where(np.isfinite(exact), exact, 0.0))
    away = np.linalg.norm(origins - points(shape)[0], axis=-1)
    found: Array = SLACK * U * (far + away + size(shape) + lever(shape))
    return found


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
    return Facts(exact, thicker.nearest(), thinner.nearest(), *starts, in_shell)


def facts_of_each(shape: Shape, origins: Array, directions: Array, t: Array) -> Facts:
    """The same, each ray on its own in 60 digits: slow."""
    answers = [facts_of_one(shape, *ray) for ray in zip(origins, directions, t, strict=True)]
    return Facts(*(np.array(column) for column in zip(*answers, strict=True)))


def facts_of_one(shape: Shape, origin: Array, direction: Array, t: float) -> Facts:
    def nearest(by: mpfr) -> float:
        found = oracle.nearest(shape, origin, direction, by)
        return np.inf if found is None else float(found)

    exact = nearest(mpfr(0))
    band = mpfr(float(swell(shape, origin[None], np.array([t]), np.array([exact]))[0]))
    at = [mpfr(o) + mpfr(t if np.isfinite(t) else 0.0) * mpfr(d) for o, d in zip(origin, direction, strict=True)]
    thicker, thinner = body(shape, band), body(shape, -band)
    if thicker.solid:
        starts = inside(thicker, list(origin)), inside(thinner, list(origin))
        in_shell = inside(thicker, at) and not inside(thinner, at)
    else:
        starts = abs(thicker.walls[0](oracle.exact(origin))) <= band, False
        in_shell = abs(thicker.walls[0](at)) <= band and all(clip(at) <= 0 for clip in thicker.clips)
    return Facts(*(np.array(each) for each in (exact, nearest(band), nearest(-band), *starts, in_shell)))
