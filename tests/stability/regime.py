"""Regimes: rays that are hard in one respect, their exact answers, the backward bound of all hits, and certificates."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache, cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np
from gmpy2 import mpfr, sqrt

from minirt.element import fields_of
from minirt.fields import Length, Lengths, Point
from minirt.rendering.queries.certificates import ROUNDED, Certificate, certify
from minirt.rendering.queries.certificates import Rays as HitRays
from minirt.shapes import Shape
from tests import oracle
from tests.oracle.body import Implicit, Vector, body, dot, exact, gradient, inside, minus, unit
from tests.shapes.execution_modes import surfaces
from tests.shapes.regimes import Array, Rays

BOUND = 4.0  # of the backward error of any hit, in units of 2^-53 (t + |o - c| + size)
U = 2.0**-53
STEEPEST = 1e-6  # relative tolerance; beyond it the surface turns away within the error, and no first order holds


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


def normals_of(rays: Rays, t: Array) -> Array:
    """The normals of hits at t, by the interpreted formulas."""
    points = rays.origins + np.where(np.isfinite(t), t, 0.0)[..., None] * rays.directions
    return surfaces(rays.shapes, points)[1]


def derived_tolerance(rays: Rays, t: Array) -> Array:
    """The relative tolerance of t that follows from the backward bound: the bound times the condition number."""
    condition = certified(rays, t).condition
    return np.minimum(BOUND * U * np.nan_to_num(condition, nan=0.0), STEEPEST)


def away_from_surface(rays: Rays, t: Array) -> list[str]:
    """Complaints about hits that are farther from the surface than the backward bound."""
    errors = certified(rays, t, normals_of(rays, t)).backward_error
    with np.errstate(invalid="ignore"):
        beyond = np.argwhere(np.isfinite(t) & ~(errors <= BOUND)).tolist()
    return [complaint(rays.shapes[i], rays.origins[i, j], rays.directions[i, j], errors[i, j]) for i, j in beyond]


def complaint(shape: Shape, origin: Array, direction: Array, error: float) -> str:
    """Say how far a hit is from the surface."""
    return f"backward error {error:.3g}: {shape} from {origin.tolist()}, {direction.tolist()}"


class Regime(NamedTuple):
    """A recipe for rays, and the tolerance of their answers.

    An answer passes that is exact within the relative error that follows from the backward bound of all hits, which is
    the bound times the condition number of t (`tests.stability.regime`); or within a `tolerance`, where formulas
    promise more, or rays are too many to certify. Where the surface ends or turns away from the ray an
    exact answer is of no use, as rounding the ray's own numbers changes it: there it passes if it lies between those
    for a shape thicker and one thinner by `slack` roundings of t, of the distance between origin and shape and of the
    shape's size, and, where all three hit, if it is one of those within `blur`. Where the thinner one is missed, and
    it is a solid, any hit in the thicker one passes: along a straight side the ends of that may be far away.

    A sheet is larger and smaller instead of thicker and thinner, and no tolerance is chosen for it: of a ray at a slope
    s to it, t may be off by 4 roundings of t and of the way from the origin to the sheet, by s. So much changes when
    the origin moves by these roundings.
    """

    name: str
    make: Callable[[], Rays]
    tolerance: float | None = None
    slack: float = 64.0
    blur: float = 1e-13
    nearest: Callable[..., Any] = oracle.nearest  # or `oracle.onward`, for rays that start on the surface


class Right:
    """The rays of a regime and their exact answers, computed on demand."""

    def __init__(self, regime: Regime, rays: Rays) -> None:
        self.regime, self.rays = regime, rays
        self.solid = body(rays.shapes[0]).solid
        self.normal = lru_cache(None)(lambda i: oracle.normal(rays.shapes[i], rays.origins[i, 0]))  # of a sheet
        self.t = np.array([[self.at(i, j) for j in range(rays.origins.shape[1])] for i in range(len(rays.shapes))])
        self.around = lru_cache(None)(self.thicker_and_thinner)

    @cached_property
    def tolerances(self) -> Array:
        """The relative tolerance of each hit."""
        given = self.regime.tolerance
        return derived_tolerance(self.rays, self.t) if given is None else np.full(self.t.shape, given)

    def at(self, i: int, j: int, swell: float = 0.0) -> float:
        t = self.regime.nearest(self.rays.shapes[i], self.rays.origins[i, j], self.rays.directions[i, j], mpfr(swell))
        return np.inf if t is None else float(t)

    def thicker_and_thinner(self, i: int, j: int) -> tuple[float, float]:
        swell = self.swell(i, j)
        return self.at(i, j, swell), self.at(i, j, -swell)

    def swell(self, i: int, j: int) -> float:
        t = self.t[i, j]
        return self.regime.slack * U * ((t if np.isfinite(t) else 0.0) + self.away(i, j) + size(self.rays.shapes[i]))

    def away(self, i: int, j: int) -> float:
        return float(np.linalg.norm(self.rays.origins[i, j] - points(self.rays.shapes[i])[0]))

    def sheet_error(self, i: int, j: int, t: float) -> float:
        """The tolerance of a hit of a sheet at t."""
        slope = float(abs(oracle.dot(self.normal(i), self.rays.directions[i, j])))
        return 4 * U * (t + self.away(i, j)) / slope

    def within_thicker(self, i: int, j: int, t: float) -> bool:
        origin, direction = self.rays.origins[i, j], self.rays.directions[i, j]
        point = [mpfr(o) + mpfr(t) * mpfr(d) for o, d in zip(origin, direction, strict=True)]
        return inside(body(self.rays.shapes[i], mpfr(self.swell(i, j))), point)

    def wrong(self, t: Array) -> list[str]:
        """Complaints about the answers t; infinity is a miss."""
        with np.errstate(invalid="ignore"):
            near = np.isfinite(self.t) & (np.abs(t - self.t) <= self.tolerances * self.t)
        exact = (t == self.t) | (near & self.solid)
        found = (self.verdict(i, j, t[i, j]) for i, j in np.argwhere(~exact).tolist())
        return [each for each in found if each]

    def verdict(self, i: int, j: int, t: float) -> str:
        """A complaint about an answer that is not exact; empty if it is near enough."""
        if not self.solid and abs(t - self.t[i, j]) < self.sheet_error(i, j, self.t[i, j]):  # not inf < inf
            return ""
        sides = [self.t[i, j], *self.around(i, j)]
        hits = [side for side in sides if np.isfinite(side)]
        if np.isinf(t):
            fine = len(hits) < 3
        elif not self.solid:
            fine = 0 < len(hits) < 3 and abs(t - hits[0]) <= self.sheet_error(i, j, hits[0])
        else:
            fine = bool(hits) and min(hits) * (1 - U) <= t <= max(hits) * (1 + self.regime.blur)
            fine &= len(hits) < 3 or min(abs(t - side) / side for side in sides) <= self.regime.blur
            fine |= len(hits) < 3 and self.within_thicker(i, j, t)
        if fine:
            return ""
        ray = f"{self.rays.origins[i, j].tolist()}, {self.rays.directions[i, j].tolist()}"
        return f"t = {t!r}, not {sides[0]!r}, with slack {sides[1:]}: {self.rays.shapes[i]} from {ray}"


@cache
def posed(regime: Regime) -> Right:
    """The rays of a regime and the exact answers, computed once."""
    return Right(regime, regime.make())


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
