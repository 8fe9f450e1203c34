"""Double-double numbers with their gradients: unevaluated sums of two float64, exact to about 2^-104 of their size.

They are for checking, not for rendering: the `boundary` of a shape, computed with them, tells how far a point that was
computed in float64 is from the surface, where float64 itself sees only rounding. An operation costs some tens of
operations of numpy. Algorithms: Dekker, A Floating-Point Technique for Extending the Available Precision (1971); Hida,
Li and Bailey, Algorithms for Quad-Double Precision Floating Point Arithmetic (2001). Gradients are carried forward in
float64 by the chain rule (automatic differentiation, Wengert 1964).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from minirt.lanes import Vec
from minirt.shapes.compensated import two_product, two_sum

NO_SLOPE = Vec(0.0, 0.0, 0.0)


class Double:
    """The number `high` + `low`, and its gradient `slope` with respect to a point; float64 arrays of one length.

    `low` is at most half a unit in the last place of `high`. Sums, differences, products and quotients with float64
    take these as exact constants.
    """

    __array_ufunc__ = None  # an array times a Double is a Double, not an array of Doubles
    __slots__ = ("high", "low", "slope")

    def __init__(self, high: Any, low: Any = 0.0, slope: Vec = NO_SLOPE) -> None:
        self.high, self.low, self.slope = high, low, slope

    def __add__(self, other: Any) -> Double:
        other = as_double(other)
        high, error = two_sum(self.high, other.high)
        low, last = two_sum(self.low, other.low)
        high, error = quick_two_sum(high, error + low)
        return Double(*quick_two_sum(high, error + last), self.slope + other.slope)

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, Vec):
            return NotImplemented  # a Vec multiplies its components
        other = as_double(other)
        high, error = two_product(self.high, other.high)
        error = error + (self.high * other.low + self.low * other.high)
        return Double(*quick_two_sum(high, error), other.high * self.slope + self.high * other.slope)

    def __truediv__(self, other: Any) -> Double:
        other = as_double(other)
        constant = Double(other.high, other.low)
        first = self.high / other.high
        rest = Double(self.high, self.low) - constant * first
        second = rest.high / other.high
        third = (rest - constant * second).high / other.high
        high, low = quick_two_sum(first, second)
        return Double(*quick_two_sum(high, low + third), (self.slope - high * other.slope) / other.high)

    def __neg__(self) -> Double:
        return Double(-self.high, -self.low, -self.slope)

    def __abs__(self) -> Double:
        sign = np.where(self.high < 0.0, -1.0, 1.0)
        return Double(sign * self.high, sign * self.low, sign * self.slope)

    def __sub__(self, other: Any) -> Double:
        return self + -as_double(other)

    def __rsub__(self, other: Any) -> Double:
        return as_double(other) - self

    def __rtruediv__(self, other: Any) -> Double:
        return as_double(other) / self

    __radd__, __rmul__ = __add__, __mul__

    def root(self) -> Double:
        """The square root; that of 0, and of rounding errors below it, is 0 with the gradient 0."""
        root = np.sqrt(np.maximum(self.high, 0.0))
        per_root = np.where(root > 0.0, 0.5 / np.where(root > 0.0, root, 1.0), 0.0)
        square, error = two_product(root, root)
        rest = Double(self.high, self.low) - Double(square, error)
        return Double(*quick_two_sum(root, rest.high * per_root), per_root * self.slope)

    def scaled(self, power: Any) -> Double:
        """The number times 2^power, for any power."""
        slope = (np.ldexp(part, power) for part in (self.slope.x, self.slope.y, self.slope.z))
        return Double(np.ldexp(self.high, power), np.ldexp(self.low, power), Vec(*slope))

    def rounded(self) -> Any:
        """The number in float64."""
        return self.high + self.low


def as_double(x: Any) -> Double:
    """Return a number as a Double: a float64 as a constant."""
    return x if isinstance(x, Double) else Double(np.asarray(x, np.float64))


def quick_two_sum(a: Any, b: Any) -> tuple[Any, Any]:
    """The rounded sum a + b and its rounding error, for |a| >= |b| (Dekker 1971)."""
    total = a + b
    return total, b - (total - a)
