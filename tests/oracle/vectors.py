"""Vectors whose components are multiple-precision numbers or polynomials."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from gmpy2 import const_pi, cos, get_context, mpfr, sin, sqrt

Vector = list[Any]

BITS = 203  # of precision, 60 digits: MPFR, in a seventh of the time of Python's decimal
get_context().precision = BITS


def exact(numbers: Iterable[Any]) -> Vector:
    """Convert floating-point numbers exactly."""
    return [number if isinstance(number, mpfr) else mpfr(float(number)) for number in numbers]


def unit(numbers: Iterable[Any]) -> Vector:
    """Scale a direction, which is of unit length but for rounding, to length 1."""
    v = exact(numbers)
    length = sqrt(dot(v, v))
    return [x / length for x in v]


def minus(a: Vector, b: Vector) -> Vector:
    return [x - y for x, y in zip(a, b, strict=True)]


def dot(a: Vector, b: Vector) -> Any:
    x, y, z = (p * q for p, q in zip(a, b, strict=True))
    return x + y + z


def cross(a: Vector, b: Vector) -> Vector:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def own_axes(axis: Iterable[Any], roll: float) -> list[Vector]:
    """The x, y and z axes of a shape whose own y axis is `axis`: those of the scene, turned about x and z as little as
    brings y to the axis or to its opposite, and then about y by `roll` degrees."""
    y = unit(axis)
    sign = 1 if y[1] >= 0 else -1
    # Half a turn about the bisector of the axis and the scene's y, or its opposite, brings that y to the axis, and x
    # and z to the opposites of its own.
    middle = unit([y[0], y[1] + sign, y[2]])

    def turned(v: Vector) -> Vector:
        return [2 * dot(v, middle) * m - x for x, m in zip(v, middle, strict=True)]

    x = turned(exact((1, 0, 0)))
    z, x = rolled(cross(x, y), x, roll)
    return [x, y, z]


def rolled(a: Vector, b: Vector, degrees: float) -> tuple[Vector, Vector]:
    """Turn two perpendicular unit vectors in their plane, from a towards b."""
    angle = mpfr(degrees) * const_pi() / 180
    c, s = cos(angle), sin(angle)
    return [c * x + s * y for x, y in zip(a, b, strict=True)], [c * y - s * x for x, y in zip(a, b, strict=True)]
