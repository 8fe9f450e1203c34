"""Certificates of hits to 60 digits, from the oracle's implicit functions: what `Hits.backward_error` must be."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from gmpy2 import mpfr, sqrt

from minirt.shapes import Shape
from tests.oracle.body import Implicit, body, gradient
from tests.oracle.vectors import Vector, dot, exact, minus, unit
from tests.stability.regime import U, points, size

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
    wall = max(form.walls, key=lambda each: dot(unit(gradient(each, point)), exact(normal)))
    nearest = foot(wall, point)
    if nearest is None:
        return None
    ends = [*form.clips, *(other for other in form.walls if other is not wall)]
    beyond = max([mpfr(0), *(height(end, point) for end in ends)])
    away = minus(o, exact(points(shape)[0]))
    magnitude = mpfr(t) + sqrt(dot(away, away)) + mpfr(size(shape))
    out = unit(gradient(wall, nearest))
    off, turned = minus(nearest, point), minus(out, exact(normal))
    return ExactCertificate(
        float(max(sqrt(dot(off, off)), beyond) / (mpfr(U) * magnitude)),
        float(magnitude / (mpfr(t) * abs(dot(out, d)))),
        float(sqrt(dot(turned, turned))),
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
