"""The oracle for many rays at once, in numbers of 106 bits: the same bodies, for a first look at a million rays."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from gmpy2 import mpfr
from numpy.typing import NDArray

from minirt.element import fields_of
from minirt.fields import Point
from minirt.shapes import Shape, boundary
from tests.oracle.body import Polynomial, body

Array = NDArray[np.float64]


class DoubleDouble(boundary.DoubleDouble):
    """An array of numbers without gradients; float64, int and mpfr are converted where they meet one."""

    __slots__ = ()

    def __add__(self, other: Any) -> DoubleDouble:
        return NotImplemented if hasattr(other, "coefficients") else plain(super().__add__(double_double(other)))

    def __mul__(self, other: Any) -> DoubleDouble:
        return NotImplemented if hasattr(other, "coefficients") else plain(super().__mul__(double_double(other)))

    def __truediv__(self, other: Any) -> DoubleDouble:
        return plain(super().__truediv__(double_double(other)))

    def __rtruediv__(self, other: Any) -> DoubleDouble:
        return double_double(other) / self

    def __neg__(self) -> DoubleDouble:
        return DoubleDouble(-self.high, -self.low)

    def __sub__(self, other: Any) -> DoubleDouble:
        return self + -other

    def __rsub__(self, other: Any) -> DoubleDouble:
        return -self + other

    def __pow__(self, exponent: int) -> DoubleDouble:
        return self if exponent == 1 else self * self ** (exponent - 1)

    def __abs__(self) -> DoubleDouble:
        return plain(super().__abs__())

    def root(self) -> DoubleDouble:
        return plain(super().root())

    __radd__, __rmul__ = __add__, __mul__


def plain(number: boundary.DoubleDouble) -> DoubleDouble:
    """The number without its gradient."""
    return DoubleDouble(number.high, number.low)


def double_double(number: Any) -> DoubleDouble:
    if isinstance(number, DoubleDouble):
        return number
    high = np.asarray(number, float) if isinstance(number, np.ndarray) else np.float64(number)
    return DoubleDouble(high, np.float64(number - mpfr(float(high))) if isinstance(number, mpfr) else 0.0)


def where(mask: Any, number: DoubleDouble) -> DoubleDouble:
    """The number where the mask is true, elsewhere NaN."""
    return DoubleDouble(np.where(mask, number.high, np.nan), np.where(mask, number.low, np.nan))


BISECTIONS = 58  # leave a root to the last bits of float64


class Along(Polynomial):
    """Polynomials c0 + c1 t + c2 t^2 + ..., one for each ray: the numbers of a point that moves along it."""

    number = staticmethod(double_double)

    def rough(self, t: Array) -> Array:
        """The values at t, rounded like float64."""
        value = self.coefficients[-1].high
        for c in reversed(self.coefficients[:-1]):
            value = value * t + c.high
        return value

    def noise(self, t: Array) -> Array:
        """Of the values at t a share that is surely below their rounding."""
        value = np.abs(self.coefficients[-1].high)
        for c in reversed(self.coefficients[:-1]):
            value = value * np.abs(t) + np.abs(c.high)
        return 2.0**-88 * value

    def roots(self) -> list[DoubleDouble]:
        """The real roots, in no order; those that are not there are NaN."""
        degree = len(self.coefficients) - 1
        if degree == 0:
            return []
        if degree == 1:
            return [-(self.coefficients[0] / self.coefficients[1])]
        return self.of_quadratic() if degree == 2 else self.between_turns()

    def of_quadratic(self) -> list[DoubleDouble]:
        c, b, a = self.coefficients
        b = b * 0.5
        D = b * b - a * c
        q = -(b + D.root() * np.where(b.high < 0, -1.0, 1.0))
        real = D.high >= -(2.0**-96) * (b.high * b.high + np.abs(a.high * c.high))
        straight = np.abs(a.high) <= 2.0**-98 * np.abs(c.high)
        return [where(real & ~straight, q / a), where(real, c / q)]

    def between_turns(self) -> list[DoubleDouble]:
        """Of a cubic or more: one root between two turning points with different signs."""
        slope = self.derivative()
        turns = np.sort(np.stack(np.broadcast_arrays(*(turn.high for turn in slope.roots()))), axis=0)  # NaN come last
        top = np.abs(self.coefficients[-1].high)
        degree = len(self.coefficients) - 1
        shares = [(np.abs(c.high) / top) ** (1 / (degree - k)) for k, c in enumerate(self.coefficients[:-1])]
        end = np.asarray(4 * np.maximum.reduce(np.broadcast_arrays(*shares)))  # twice Fujiwara's bound, see `body`
        ends = [-end, *np.where(np.isnan(turns), end, turns), end]
        found = []
        for low, high in pairwise(ends):
            crosses = (self(low).high * self(high).high <= 0) & (low < high)
            exact = DoubleDouble(self.bisected(low, high))
            for _ in range(3):
                step = self(exact) / slope(exact)
                fine = np.abs(step.high) <= 2.0**-20 * end
                exact = exact - DoubleDouble(np.where(fine, step.high, 0.0), np.where(fine, step.low, 0.0))
            found.append(where(crosses, exact))
        return found

    def bisected(self, low: Array, high: Array) -> Array:
        """The root between two t with different signs, rounded like float64."""
        first, t = self(low).high, 0.5 * (low + high)
        for _ in range(BISECTIONS):
            before = self.rough(t) * first > 0
            low, high = np.where(before, t, low), np.where(before, high, t)
            t = 0.5 * (low + high)
        return t


class Crossed(NamedTuple):
    """A shape, moved outwards by a `swell` for each ray, along n rays: o + (t - approach) d with o close to it."""

    walls: list[Along]
    clips: list[Along]
    approach: Array
    solid: bool

    def nearest(self) -> Array:
        """The least t > 0 at which each ray meets the surface, infinity where none does."""
        least = np.full(self.approach.shape, np.inf)
        for wall in self.walls:
            others = [*self.clips, *(other for other in self.walls if other is not wall and self.solid)]
            for root in wall.roots():
                on = np.ones(least.shape, bool)
                for other in others:
                    on &= other(root).high <= other.noise(root.high)
                t = (root + self.approach).high
                least = np.where(on & (t > 0) & (t < least), t, least)
        return least

    def height(self, t: Array) -> Array:
        """The heights above a sheet's plane of the points at t."""
        return np.asarray(self.walls[0](DoubleDouble(t) - self.approach).high)

    def within(self, t: Array) -> Array:
        """Whether the points at t are within a sheet's edges."""
        at = DoubleDouble(t) - self.approach
        return np.logical_and.reduce([np.ones(t.shape, bool), *(clip(at).high <= 0 for clip in self.clips)])

    def inside(self, t: Array) -> Array:
        """Whether the points at t are inside and not on the surface."""
        at = DoubleDouble(t) - self.approach
        within = np.full(self.approach.shape, self.solid)
        for wall in self.walls:
            within &= wall(at).high < 0
        for clip in self.clips:
            within &= clip(at).high <= 0
        return within


def crossed(shape: Shape, origins: Array, directions: Array, swell: Any = 0) -> Crossed:
    """A shape along rays (n, 3)."""
    point = next(getattr(shape, each.name) for each in fields_of(type(shape)) if isinstance(each, Point))
    approach = np.sum((np.array(point) - origins) * directions, axis=-1)
    start = [DoubleDouble(o) + DoubleDouble(d) * approach for o, d in zip(origins.T, directions.T, strict=True)]
    ray = [Along(o, d) for o, d in zip(start, directions.T, strict=True)]
    each = body(shape, DoubleDouble(swell) if isinstance(swell, np.ndarray) else swell)
    walls, clips = ([as_along(f(ray)) for f in functions] for functions in (each.walls, each.clips))
    return Crossed(walls, clips, approach, each.solid)


def as_along(value: Any) -> Along:
    return value if isinstance(value, Along) else Along(value)
