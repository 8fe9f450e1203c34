"""Arrays of numbers of 106 bits, each the unrounded sum of two float64.

The implicit functions of the oracle take them as they take multiple-precision numbers, a hundred times as fast (Dekker,
A Floating-Point Technique for Extending the Available Precision, 1971).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from gmpy2 import mpfr
from numpy.typing import NDArray

Array = NDArray[np.float64]
SPLIT = 2.0**27 + 1.0


def two_sum(a: Array, b: Array) -> tuple[Array, Array]:
    """The rounded sum and its error."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def halves(a: Array) -> tuple[Array, Array]:
    """The upper and the lower half of the bits."""
    shifted = SPLIT * a
    high = shifted - (shifted - a)
    return high, a - high


class DoubleDouble:
    """An array of numbers; float64, int and mpfr are converted where they meet one."""

    __array_ufunc__ = None  # a numpy array times one is one
    __slots__ = ("high", "low")

    def __init__(self, high: Any, low: Any = 0.0) -> None:
        self.high, self.low = high, low

    def __add__(self, other: Any) -> DoubleDouble:
        if hasattr(other, "coefficients"):  # a polynomial
            return NotImplemented
        b = double_double(other)
        high, error = two_sum(self.high, b.high)
        return normalised(high, error + (self.low + b.low))

    def __mul__(self, other: Any) -> DoubleDouble:
        if hasattr(other, "coefficients"):  # a polynomial
            return NotImplemented
        b = double_double(other)
        high = self.high * b.high
        (a1, a0), (b1, b0) = halves(self.high), halves(b.high)
        error = a0 * b0 - (((high - a1 * b1) - a0 * b1) - a1 * b0)
        return normalised(high, error + (self.high * b.low + self.low * b.high))

    def __truediv__(self, other: Any) -> DoubleDouble:
        b = double_double(other)
        first = self.high / b.high
        rest = self - b * first
        second = rest.high / b.high
        return normalised(first, second) + (rest - b * second).high / b.high

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
        sign = np.where(self.high < 0, -1.0, 1.0)
        return DoubleDouble(sign * self.high, sign * self.low)

    def root(self) -> DoubleDouble:
        """The square root, of negative numbers 0."""
        guess = np.sqrt(np.maximum(self.high, 0.0))
        half = 0.5 / np.where(guess > 0, guess, np.inf)
        return normalised(guess, (self - DoubleDouble(guess) * guess).high * half)

    __radd__, __rmul__ = __add__, __mul__


def normalised(high: Array, low: Array) -> DoubleDouble:
    total = high + low
    return DoubleDouble(total, low - (total - high))


def double_double(number: Any) -> DoubleDouble:
    if isinstance(number, DoubleDouble):
        return number
    high = np.asarray(number, float) if isinstance(number, np.ndarray) else np.float64(number)
    return DoubleDouble(high, np.float64(number - mpfr(float(high))) if isinstance(number, mpfr) else 0.0)


def where(mask: Any, number: DoubleDouble) -> DoubleDouble:
    """The number where the mask is true, elsewhere NaN."""
    return DoubleDouble(np.where(mask, number.high, np.nan), np.where(mask, number.low, np.nan))
