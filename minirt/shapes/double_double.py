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


class DoubleDouble:
    """The number `high` + `low`, and its gradient `slope` with respect to a point; float64 arrays of one length.

    `low` is at most half a unit in the last place of `high`. Sums, differences, products and quotients with float64
    take these as exact constants.
    """

    __array_ufunc__ = None  # an array times a DoubleDouble is one, too, not an array of them
    __slots__ = ("high", "low", "slope")

    def __init__(self, high: Any, low: Any = 0.0, slope: Vec = NO_SLOPE) -> None:
        self.high, self.low, self.slope = high, low, slope

    def __add__(self, other: Any) -> DoubleDouble:
        other = as_double_double(other)
        high, error = two_sum(self.high, other.high)
        low, last = two_sum(self.low, other.low)
        high, error = quick_two_sum(high, error + low)
        return DoubleDouble(*quick_two_sum(high, error + last), self.slope + other.slope)

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, Vec):
            return NotImplemented  # a Vec multiplies its components
        other = as_double_double(other)
        high, error = two_product(self.high, other.high)
        error = error + (self.high * other.low + self.low * other.high)
        return DoubleDouble(*quick_two_sum(high, error), other.high * self.slope + self.high * other.slope)

    def __truediv__(self, other: Any) -> DoubleDouble:
        other = as_double_double(other)
        constant = DoubleDouble(other.high, other.low)
        first = self.high / other.high
        rest = DoubleDouble(self.high, self.low) - constant * first
        second = rest.high / other.high
        third = (rest - constant * second).high / other.high
        high, low = quick_two_sum(first, second)
        return DoubleDouble(*quick_two_sum(high, low + third), (self.slope - high * other.slope) / other.high)

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
        square, error = two_product(root, root)
        rest = DoubleDouble(self.high, self.low) - DoubleDouble(square, error)
        return DoubleDouble(*quick_two_sum(root, rest.high * per_root), per_root * self.slope)

    def scaled(self, power: Any) -> DoubleDouble:
        """The number times 2^power, for any power."""
        slope = (np.ldexp(part, power) for part in (self.slope.x, self.slope.y, self.slope.z))
        return DoubleDouble(np.ldexp(self.high, power), np.ldexp(self.low, power), Vec(*slope))

    def rounded(self) -> Any:
        """The number in float64."""
        return self.high + self.low


def as_double_double(x: Any) -> DoubleDouble:
    """Return a number as a DoubleDouble: a float64 as a constant."""
    return x if isinstance(x, DoubleDouble) else DoubleDouble(np.asarray(x, np.float64))


def quick_two_sum(a: Any, b: Any) -> tuple[Any, Any]:
    """The rounded sum a + b and its rounding error, for |a| >= |b| (Dekker 1971)."""
    total = a + b
    return total, b - (total - a)
