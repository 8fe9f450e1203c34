"""Boundaries of shapes: their faces, as functions of a point that are 0 there, in double-double numbers.

A file of a shape declares `boundary(shape, point)`, which `minirt.rendering.queries.certificates` calls to check hits:

    def boundary(sphere: Any, point: Vec) -> Boundary:
        return Boundary((length(point - sphere.centre) - sphere.diameter / 2,))

`shape` has the fields of the scene line, or of the packed form of a mesh's triangle, and directions have exactly unit
length. Numbers are `DoubleDouble`, unevaluated sums of two float64 with their gradients, exact to about 2^-104 of their
size: use + - * /, abs, their method `root` and what is here. They tell how far a point that was computed in float64 is
from the surface, where float64 itself sees only rounding. An operation costs some tens of operations of numpy.
Algorithms: Dekker, A Floating-Point Technique for Extending the Available Precision (1971); Hida, Li and Bailey,
Algorithms for Quad-Double Precision Floating Point Arithmetic (2001). Gradients are carried forward in float64 by the
chain rule (automatic differentiation, Wengert 1964).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from minirt.lanes import Vec, cross, dot, where
from minirt.shapes.compensated import Pair, minus, plus, quick_two_sum, times, two_product, value

Roll = tuple[Any, Any]  # cosine and sine of a shape's turn about its own axis; their squares add up to exactly 1
NO_SLOPE = Vec(0.0, 0.0, 0.0)


class DoubleDouble:
    """The number `high` + `low`, and its gradient `slope` with respect to a point; float64 arrays of one length.

    `low` is at most a few units in the last place of `high`. Sums, differences, products and quotients with float64
    take these as exact constants.
    """

    __array_ufunc__ = None  # an array times a DoubleDouble is one, too, not an array of them
    __slots__ = ("high", "low", "slope")

    def __init__(self, high: Any, low: Any = 0.0, slope: Vec = NO_SLOPE) -> None:
        self.high, self.low, self.slope = high, low, slope

    @property
    def pair(self) -> Pair:
        """The number without its gradient."""
        return self.high, self.low

    def __add__(self, other: Any) -> DoubleDouble:
        other = as_double_double(other)
        return DoubleDouble(*plus(self.pair, other.pair), self.slope + other.slope)

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, Vec):
            return NotImplemented  # a Vec multiplies its components
        other = as_double_double(other)
        return DoubleDouble(*times(self.pair, other.pair), other.high * self.slope + self.high * other.slope)

    def __truediv__(self, other: Any) -> DoubleDouble:
        other = as_double_double(other)
        first = self.high / other.high
        rest = minus(self.pair, times(other.pair, (first, 0.0 * first)))
        quotient = quick_two_sum(first, value(rest) / other.high)
        return DoubleDouble(*quotient, (self.slope - quotient[0] * other.slope) / other.high)

    def __neg__(self) -> DoubleDouble:
        return DoubleDouble(-self.high, -self.low, -self.slope)

    def __abs__(self) -> DoubleDouble:
        sign = np.where(self.high < 0.0, -1.0, 1.0)
        return DoubleDouble(sign * self.high, sign * self.low, sign * self.slope)

    def __sub__(self, other: Any) -> DoubleDouble:
        return self + -as_double_double(other)

    def __rsub__(self, other: Any) -> DoubleDouble:
        return as_double_double(other) - self

    def __rtruediv__(self, other: Any) -> DoubleDouble:
        return as_double_double(other) / self

    __radd__, __rmul__ = __add__, __mul__

    def root(self) -> DoubleDouble:
        """The square root; that of 0, and of rounding errors below it, is 0 with the gradient 0."""
        root = np.sqrt(np.maximum(self.high, 0.0))
        per_root = np.where(root > 0.0, 0.5 / np.where(root > 0.0, root, 1.0), 0.0)
        rest = value(minus(self.pair, two_product(root, root)))
        return DoubleDouble(*quick_two_sum(root, rest * per_root), per_root * self.slope)

    def scaled(self, power: Any) -> DoubleDouble:
        """The number times 2^power, for any power."""
        slope = (np.ldexp(part, power) for part in (self.slope.x, self.slope.y, self.slope.z))
        return DoubleDouble(np.ldexp(self.high, power), np.ldexp(self.low, power), Vec(*slope))

    def rounded(self) -> Any:
        """The number in float64."""
        return value(self.pair)


def as_double_double(x: Any) -> DoubleDouble:
    """Return a number as a DoubleDouble: a float64 as a constant."""
    return x if isinstance(x, DoubleDouble) else DoubleDouble(np.asarray(x, np.float64))


class Boundary(NamedTuple):
    """Faces of a shape, and where they end: numbers that belong to a point, < 0 inside.

    A face is where one of `faces` is 0, and neither another face nor one of the `limits`, which are edges of a sheet or
    ends without a face, is above 0. The numbers are distances or, close to the face, nearly proportional to them.
    Normals point to where they grow.
    """

    faces: tuple[DoubleDouble, ...]
    limits: tuple[DoubleDouble, ...] = ()


def length(v: Vec) -> DoubleDouble:
    """Return the length of a vector."""
    root: DoubleDouble = dot(v, v).root()
    return root


def maximum(a: Any, b: Any) -> Any:
    """Return the greater of two numbers, the one that bounds the intersection of two solids."""
    return 0.5 * (a + b + abs(a - b))


def minimum(a: Any, b: Any) -> Any:
    """Return the lesser of two numbers, the one that bounds the union of two solids."""
    return 0.5 * (a + b - abs(a - b))


def clamp(x: Any, low: Any, high: Any) -> Any:
    """Return the number between `low` and `high` that is nearest to x."""
    return minimum(maximum(x, low), high)


def unit(v: Vec) -> Vec:
    """Return the vector of length 1 in the direction of v, however short v is."""
    power = -np.frexp(np.maximum(np.maximum(abs(v.x.high), abs(v.y.high)), abs(v.z.high)))[1]
    scaled = Vec(v.x.scaled(power), v.y.scaled(power), v.z.scaled(power))
    return scaled / length(scaled)


def hypotenuse(a: DoubleDouble, b: DoubleDouble) -> DoubleDouble:
    """Return sqrt(a^2 + b^2)."""
    return (a * a + b * b).root()


def along_and_off_axis(axis: Vec, p: Vec) -> tuple[DoubleDouble, DoubleDouble]:
    """Return the coordinate of p along a unit vector, and its distance from the line through the origin along it.

    On that line, where the distance grows in all directions off it, it has the gradient in one of them.
    """
    height = dot(axis, p)
    rho = length(p - height * axis)
    on_axis = rho.high == 0.0
    if on_axis.any():
        aside, _ = upright_frame(axis, (1.0, 0.0))
        rho.slope = where(on_axis, Vec(aside.x.high, aside.y.high, aside.z.high), rho.slope)
    return height, rho


def own_coordinates(axis: Vec, roll: Roll, p: Vec) -> tuple[DoubleDouble, DoubleDouble, DoubleDouble]:
    """Return p in the frame of a shape whose own y axis is `axis`: as `minirt.shapes.frames.basis`, exactly."""
    x, y, z = axis.x, axis.y, axis.z
    sign = np.copysign(1.0, y.high)
    a = -1.0 / (sign + y)
    b = z * x * a
    own_x, own_z = Vec(sign + x * x * a, -x, b), Vec(sign * b, -sign * z, 1.0 + sign * (z * z * a))
    c, s = roll
    x, z = dot(own_x, p), dot(own_z, p)
    return c * x - s * z, dot(axis, p), c * z + s * x


def upright_frame(normal: Vec, roll: Roll) -> tuple[Vec, Vec]:
    """Return right and up of a flat surface, as `minirt.shapes.frames.facing_frame`, exactly."""
    level = (normal.x.high == 0.0) & (normal.z.high == 0.0)
    right = unit(Vec(normal.z + np.where(level, 1.0, 0.0), 0.0 * normal.y, -normal.x))
    up = cross(normal, right)
    c, s = roll
    return c * right + s * up, c * up - s * right


def facing(way: Vec, height: DoubleDouble) -> DoubleDouble:
    """Return a height above a plane, or its opposite: the one that grows along `way`."""
    return height * np.where(dot(height.slope, Vec(way.x.high, way.y.high, way.z.high)) < 0.0, -1.0, 1.0)
