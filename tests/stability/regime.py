"""Regimes: rays that are hard in one respect; the backward bound of all hits, and certificates in 60 digits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from gmpy2 import mpfr, sqrt

from minirt.element import fields_of
from minirt.fields import Length, Lengths, Point
from minirt.rendering.queries.certificates import ROUNDED, Certificate, certify
from minirt.rendering.queries.certificates import Rays as HitRays
from minirt.shapes import Shape
from tests.oracle.body import Implicit, Vector, body, dot, exact, gradient, minus, unit
from tests.shapes.execution_modes import surfaces
from tests.shapes.regimes import Array, Rays

BOUND = 4.0  # of the backward error of any hit, in units of 2^-53 (t + |o - c| + size)
U = 2.0**-53


def certified(rays: Rays, t: Array, normals: Array | None = None) -> Certificate:
    """Certify hits at t, (m, n), of m shapes by n rays; without normals, as hits of the nearest face."""
    hit = np.isfinite(t)
    owners = np.nonzero(hit)[0]
    normals = np.full((*t.shape, 3), np.nan) if normals is None else normals
    found = certify(
        tuple(rays.shapes),
        owners,
        np.zeros_like(owners),
        HitRays(rays.origins[hit], rays.directions[hit], t[hit], normals[hit]),
    )
    whole = Certificate(*np.full((3, *t.shape), np.nan))
    for all_of, these in zip(whole, found, strict=True):
        all_of[hit] = these
    return whole


def surfaces_at(rays: Rays, t: Array) -> tuple[Array, Array]:
    """Points and normals of hits at t, by the interpreted formulas."""
    return surfaces(rays.shapes, rays.origins + np.where(np.isfinite(t), t, 0.0)[..., None] * rays.directions)


def away_from_surface(rays: Rays, t: Array) -> list[str]:
    """Complaints about hits that are farther from the surface than the backward bound."""
    errors = certified(rays, t, surfaces_at(rays, t)[1]).backward_error
    with np.errstate(invalid="ignore"):
        beyond = np.argwhere(np.isfinite(t) & ~(errors <= BOUND)).tolist()
    return [complaint(rays.shapes[i], rays.origins[i, j], rays.directions[i, j], errors[i, j]) for i, j in beyond]


def complaint(shape: Shape, origin: Array, direction: Array, error: float) -> str:
    """Say how far a hit is from the surface."""
    return f"backward error {error:.3g}: {shape} from {origin.tolist()}, {direction.tolist()}"


class Regime(NamedTuple):
    """A recipe for rays that are hard in one way."""

    name: str
    make: Callable[[], Rays]
    tolerance: float | None = None  # relative error of t, where formulas promise more than the backward bound
    nearest: float = 0.0  # sizes of the shape: no hit is nearer, as those are of the surface on which a ray starts


@cache
def rays_of(regime: Regime) -> Rays:
    """The rays of a regime, made once."""
    return regime.make()


def points(shape: Shape) -> list[Array]:
    """The points that a shape is given by."""
    return [np.array(getattr(shape, each.name)) for each in fields_of(type(shape)) if isinstance(each, Point)]


def size(shape: Shape) -> float:
    """The sum of the lengths that a shape is given by and of the distances between its points."""
    lengths = [np.sum(getattr(shape, e.name)) for e in fields_of(type(shape)) if isinstance(e, (Length, Lengths))]
    first, *others = points(shape)
    return float(sum(lengths) + sum(np.linalg.norm(other - first) for other in others))


STEPS = 40  # towards the nearest point, at most
EXACT, NOTHING = mpfr("1e-9"), mpfr("1e-45")  # change of the distance in the last step, by the distance or by 1


class ExactCertificate(NamedTuple):
    """How exact a hit is: see `minirt.rendering.queries.certificates`."""

    backward_error: float
    condition: float
    normal_error: float


def certificate(
    shape: Shape, origin: Sequence[Any], direction: Sequence[Any], t: float, normal: Sequence[Any]
) -> ExactCertificate | None:
    """Certify a hit at a distance t; None where the nearest point of the surface is not found, as the surface is curved
    more strongly than the point is far from it."""
    form, o, d = body(shape), exact(origin), unit(direction)
    point = [x + mpfr(t) * y for x, y in zip(o, d, strict=True)]

    def beyond(wall: Implicit) -> mpfr:
        ends = [*form.clips, *(other for other in form.walls if other is not wall)]
        return max([mpfr(0), *(height(end, point) for end in ends)])

    def distance(wall: Implicit) -> mpfr:
        return max(abs(height(wall, point)), beyond(wall))

    wall = min(form.walls, key=distance)
    nearest = foot(wall, point)
    if nearest is None:
        return None
    away = minus(o, exact(points(shape)[0]))
    magnitude = mpfr(t) + sqrt(dot(away, away)) + mpfr(size(shape))
    rounding = ROUNDED * U * (magnitude + max(map(abs, o)))
    out = unit(gradient(wall, nearest))
    normals = [unit(gradient(each, nearest)) for each in form.walls if distance(each) <= rounding] or [out]
    off = minus(nearest, point)
    return ExactCertificate(
        float(max(sqrt(dot(off, off)), beyond(wall)) / (mpfr(U) * magnitude)),
        float(magnitude / (mpfr(t) * abs(dot(out, d)))),
        min(float(sqrt(dot(turned, turned))) for turned in (minus(each, exact(normal)) for each in normals)),
    )


def height(wall: Implicit, point: Vector) -> mpfr:
    """The height of a point above a wall, to first order."""
    slope = gradient(wall, point)
    steepness = sqrt(dot(slope, slope))
    return wall(point) / steepness if steepness else mpfr("-inf")


def foot(wall: Implicit, point: Vector) -> Vector | None:
    """The nearest point of a wall: the foot of the perpendicular on tangent planes that approach the one there."""
    at, before = point, mpfr(-1)
    for _ in range(STEPS):
        slope = gradient(wall, at)
        share = (wall(at) + dot(slope, minus(point, at))) / dot(slope, slope)
        at = [x - share * y for x, y in zip(point, slope, strict=True)]
        distance = abs(share) * sqrt(dot(slope, slope))
        if abs(distance - before) <= EXACT * distance + NOTHING:
            return at
        before = distance
    return None
