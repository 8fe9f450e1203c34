"""Bodies: shapes as implicit functions, and their intersections with rays, in multiple-precision numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import singledispatch
from itertools import pairwise, zip_longest
from typing import Any, NamedTuple, Self

from gmpy2 import const_pi, cos, get_context, mpfr, sin, sqrt

from minirt.shapes import Shape

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


EPS = mpfr(2) ** (1 - BITS)  # distance from 1 to the next number
STEPS = 1000  # of Newton's method at most; most roots take less than ten


class Polynomial:
    """The polynomial c0 + c1 t + c2 t^2 + ...

    It can be added to and multiplied with polynomials and numbers, so that a function written for numbers is expanded
    by calling it with polynomials.
    """

    def __init__(self, *coefficients: Any) -> None:
        self.coefficients = [self.number(c) for c in coefficients]

    @staticmethod
    def number(c: Any) -> Any:
        """A coefficient in the arithmetic of the polynomial."""
        return c if isinstance(c, mpfr) else mpfr(c)

    def coefficients_of(self, other: Any) -> list[Any]:
        """The coefficients of a polynomial, or of a number as a constant polynomial."""
        return other.coefficients if isinstance(other, Polynomial) else [self.number(other)]

    def __add__(self, other: Any) -> Self:
        pairs = zip_longest(self.coefficients, self.coefficients_of(other), fillvalue=self.number(0))
        return type(self)(*(a + b for a, b in pairs))

    def __mul__(self, other: Any) -> Self:
        a, b = self.coefficients, self.coefficients_of(other)
        product = [self.number(0)] * (len(a) + len(b) - 1)
        for i, x in enumerate(a):
            for j, y in enumerate(b):
                product[i + j] = x * y + product[i + j]
        return type(self)(*product)

    def __pow__(self, exponent: int) -> Self:
        return self if exponent == 1 else self * self ** (exponent - 1)

    def __neg__(self) -> Self:
        return type(self)(*(-c for c in self.coefficients))

    def __sub__(self, other: Any) -> Self:
        return self + -other

    def __rsub__(self, other: Any) -> Self:
        return -self + other

    __radd__, __rmul__ = __add__, __mul__

    def __call__(self, t: Any) -> Any:
        *others, value = self.coefficients
        for c in reversed(others):
            value = value * t + c
        return value

    def derivative(self) -> Self:
        return type(self)(*(c * k for k, c in enumerate(self.coefficients) if k))

    def roots(self) -> list[mpfr]:
        """The real roots in ascending order, multiple roots once; none for a constant.

        Between two turning points, which are the roots of the derivative, it is monotone: there is one root where the
        signs at both ends differ.
        """
        kept = self.coefficients
        while kept and kept[-1] == 0:
            kept = kept[:-1]
        if len(kept) < 3:
            return [-kept[0] / kept[1]] if len(kept) == 2 else []
        exact = Polynomial(*kept)
        turns = exact.derivative().roots()
        # All roots lie within twice the largest |a[n-k] / a[n]|^(1/k) (Fujiwara 1916).
        end = 1 + 2 * max(abs(c / kept[-1]) ** (mpfr(1) / k) for k, c in enumerate(reversed(kept[:-1]), 1))
        found = [turn for turn in turns if exact.is_zero(turn)]
        for low, high in pairwise([-end, *turns, end]):
            if exact(low) * exact(high) < 0:
                turn, side = (low, 1) if low in turns else (high, -1)
                found.append(exact.root(low, high, exact.beside(turn, side)))
        return sorted(found)

    def is_zero(self, t: mpfr) -> bool:
        """Whether the value at t is 0 within its own rounding: a double root is rarely met exactly."""
        terms = Polynomial(*map(abs, self.coefficients))
        return bool(abs(self(t)) <= 16 * EPS * terms(abs(t)))

    def beside(self, turn: mpfr, side: int) -> mpfr:
        """First guess of a root beside a turning point: the root of the parabola that fits the polynomial there."""
        bend = self.derivative().derivative()(turn)
        square = -2 * self(turn) / bend if bend else mpfr(0)
        return turn + side * sqrt(square) if square > 0 else turn

    def root(self, low: mpfr, high: mpfr, t: mpfr) -> mpfr:
        """The root between two t with different signs: Newton's method from t, and bisection where a step leaves the
        interval or does not shrink."""
        slope, below = self.derivative(), self(low)
        if low < 0 < high and self.coefficients[0] == 0:
            return mpfr(0)
        step = high - low
        for _ in range(STEPS):
            if not low < t < high:
                t = (low + high) / 2
            value = self(t)
            low, high = (t, high) if value * below > 0 else (low, t)
            last, step = step, value / slope(t)
            if abs(step) <= 8 * EPS * abs(t):
                return t - step
            t = t - step if 2 * abs(step) < abs(last) else (low + high) / 2
            if high - low <= 8 * EPS * abs(t):
                return t
        raise ArithmeticError(f"no root of {self.coefficients} in [{low}, {high}]")


Implicit = Callable[[Vector], Any]  # a polynomial of the coordinates of a point, made by + - * ** and vector functions


class Body(NamedTuple):
    """A solid or a sheet, bounded by implicit surfaces F = 0.

    A solid is where all `walls` are <= 0; its surface is where one of them is 0. A sheet, which has no inside, is where
    its one wall is 0. Both are cut off, without a surface there, where one of the `clips` is > 0. The normal points to
    where the wall grows.
    """

    walls: tuple[Implicit, ...]
    clips: tuple[Implicit, ...] = ()
    solid: bool = True


@singledispatch
def body(shape: Shape, swell: Any = 0) -> Body:
    """The body of a shape, its surface moved outwards by `swell`; of a sheet only its edges are moved."""
    path = file_of(type(shape)).replace(".", "/")
    raise TypeError(f"the oracle knows no {shape.title}: write its body into {path}.py, as tests/oracle/bodies.py does")


def file_of(shape: type[Shape]) -> str:
    """The module of this folder that registers the body of a kind of shape: it is named as the shape's own."""
    return f"{__package__}.{shape.__module__.rpartition('.')[2]}"


def crossings(each: Body, origin: Vector, direction: Vector) -> list[mpfr]:
    """All t at which the line origin + t direction meets the surface, in ascending order."""
    ray = [Polynomial(o, d) for o, d in zip(exact(origin), exact(direction), strict=True)]
    walls = [as_polynomial(wall(ray)) for wall in each.walls]
    clips = [as_polynomial(clip(ray)) for clip in each.clips]
    hits: list[mpfr] = []
    for wall in walls:
        others = [*clips, *(other for other in walls if other is not wall and each.solid)]
        hits += [t for t in wall.roots() if all(other(t) <= 0 for other in others)]
    return sorted(hits)


def meetings(each: Body, origin: Vector, direction: Vector) -> list[mpfr]:
    """All t at which the line meets one of the walls, also where that is cut off or beyond another one."""
    ray = [Polynomial(o, d) for o, d in zip(exact(origin), exact(direction), strict=True)]
    return [t for wall in each.walls for t in as_polynomial(wall(ray)).roots()]


def inside(each: Body, point: Vector) -> bool:
    """Whether a point is inside, not on the surface and not cut off; a sheet has no inside."""
    p = exact(point)
    return each.solid and all(wall(p) < 0 for wall in each.walls) and all(clip(p) <= 0 for clip in each.clips)


def normals(each: Body, point: Vector) -> list[tuple[mpfr, Vector]]:
    """The distance of a point to each wall, to first order, and its outward unit normal there; the nearest first."""
    p = exact(point)
    slopes = [(abs(wall(p)), gradient(wall, p)) for wall in each.walls]
    return sorted(((height / sqrt(dot(slope, slope)), unit(slope)) for height, slope in slopes), key=lambda w: w[0])


def gradient(wall: Implicit, point: Vector) -> Vector:
    """The gradient of a wall: its slope along an axis is the coefficient of t of the polynomial along that axis."""
    axes = ([Polynomial(x, int(i == axis)) for i, x in enumerate(point)] for axis in range(3))
    return [([*as_polynomial(wall(line)).coefficients, mpfr(0)])[1] for line in axes]


def as_polynomial(value: Any) -> Polynomial:
    return value if isinstance(value, Polynomial) else Polynomial(value)
