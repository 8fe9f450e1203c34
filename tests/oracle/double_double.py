"""Arrays of numbers of 106 bits, each the unrounded sum of two float64, and polynomials of them.

The implicit functions of the oracle take them as they take multiple-precision numbers, so that a million rays are judged
in the time of a few thousand (Dekker, A Floating-Point Technique for Extending the Available Precision, 1971).
"""

from __future__ import annotations

from itertools import zip_longest
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
        if isinstance(other, Along):
            return NotImplemented
        b = double_double(other)
        high, error = two_sum(self.high, b.high)
        return normalised(high, error + (self.low + b.low))

    def __mul__(self, other: Any) -> DoubleDouble:
        if isinstance(other, Along):
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


class Along:
    """Polynomials c0 + c1 t + c2 t^2 + ..., one for each ray: the numbers of a point that moves along it."""

    def __init__(self, *coefficients: Any) -> None:
        self.coefficients = [double_double(c) for c in coefficients]

    def __add__(self, other: Any) -> Along:
        pairs = zip_longest(self.coefficients, coefficients_of(other), fillvalue=DoubleDouble(0.0))
        return Along(*(a + b for a, b in pairs))

    def __mul__(self, other: Any) -> Along:
        a, b = self.coefficients, coefficients_of(other)
        product: list[Any] = [0.0] * (len(a) + len(b) - 1)
        for i, x in enumerate(a):
            for j, y in enumerate(b):
                product[i + j] = x * y + product[i + j]
        return Along(*product)

    def __pow__(self, exponent: int) -> Along:
        return self if exponent == 1 else self * self ** (exponent - 1)

    def __neg__(self) -> Along:
        return Along(*(-c for c in self.coefficients))

    def __sub__(self, other: Any) -> Along:
        return self + -other

    def __rsub__(self, other: Any) -> Along:
        return -self + other

    __radd__, __rmul__ = __add__, __mul__

    def __call__(self, t: Any) -> DoubleDouble:
        value = self.coefficients[-1]
        for c in reversed(self.coefficients[:-1]):
            value = value * t + c
        return value

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

    def derivative(self) -> Along:
        return Along(*(c * k for k, c in enumerate(self.coefficients) if k))

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
        root = D.root()
        q = -(b + DoubleDouble(*(np.where(b.high < 0, -part, part) for part in (root.high, root.low))))
        real = D.high >= -(2.0**-96) * (b.high * b.high + np.abs(a.high * c.high))
        flat = np.abs(a.high) <= 2.0**-98 * np.abs(c.high)
        found = [q / a, c / q]
        return [where(real & (flag if i else ~flat), t) for i, (t, flag) in enumerate(zip(found, (True, True), strict=True))]

    def between_turns(self) -> list[DoubleDouble]:
        """Of a cubic or more: one root between two turning points with different signs."""
        slope = self.derivative()
        turns = np.sort(np.stack(np.broadcast_arrays(*(turn.high for turn in slope.roots()))), axis=0)  # NaN last
        top = np.abs(self.coefficients[-1].high)
        degree = len(self.coefficients) - 1
        shares = [(np.abs(c.high) / top) ** (1 / (degree - k)) for k, c in enumerate(self.coefficients[:-1])]
        end = np.asarray(1 + 2 * np.maximum.reduce(np.broadcast_arrays(*shares)))
        ends = [-end, *np.where(np.isnan(turns), end, turns), end]
        found = []
        for low, high in zip(ends, ends[1:], strict=False):
            first = self(low).high
            crosses = (first * self(high).high <= 0) & (low < high)
            t = 0.5 * (low + high)
            for _ in range(58):
                before = self.rough(t) * first > 0
                low, high = np.where(before, t, low), np.where(before, high, t)
                t = 0.5 * (low + high)
            exact = DoubleDouble(t)
            for _ in range(3):
                step = self(exact) / slope(exact)
                fine = np.abs(step.high) <= 2.0**-20 * end
                exact = exact - DoubleDouble(np.where(fine, step.high, 0.0), np.where(fine, step.low, 0.0))
            found.append(where(crosses, exact))
        return found


def where(mask: Any, number: DoubleDouble) -> DoubleDouble:
    """The number where the mask is true, elsewhere NaN."""
    return DoubleDouble(np.where(mask, number.high, np.nan), np.where(mask, number.low, np.nan))


def coefficients_of(other: Any) -> list[DoubleDouble]:
    return other.coefficients if isinstance(other, Along) else [double_double(other)]
