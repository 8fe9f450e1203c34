"""Polynomials along many rays at once, with coefficients of 106 bits, and their real roots."""

from __future__ import annotations

from itertools import pairwise, zip_longest
from typing import Any

import numpy as np

from tests.oracle.double_double import Array, DoubleDouble, double_double, where

BISECTIONS = 58  # leave a root to the last bits of float64


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
        end = np.asarray(1 + 2 * np.maximum.reduce(np.broadcast_arrays(*shares)))
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


def coefficients_of(other: Any) -> list[DoubleDouble]:
    return other.coefficients if isinstance(other, Along) else [double_double(other)]
