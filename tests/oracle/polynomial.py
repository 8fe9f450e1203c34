"""Polynomials in one variable, with coefficients of many digits, and their real roots."""

from __future__ import annotations

from itertools import pairwise, zip_longest
from typing import Any

from gmpy2 import mpfr, sqrt

from tests.oracle.vectors import BITS

EPS = mpfr(2) ** (1 - BITS)  # by which a number is told from 1
STEPS = 1000  # at most, towards a root; most take less than ten


class Polynomial:
    """c0 + c1 t + c2 t^2 + ...: it adds to and multiplies with others and numbers, so that a function that is written
    for numbers is expanded by calling it."""

    def __init__(self, *coefficients: Any) -> None:
        self.coefficients = [c if isinstance(c, mpfr) else mpfr(c) for c in coefficients]

    def __add__(self, other: Any) -> Polynomial:
        pairs = zip_longest(self.coefficients, coefficients_of(other), fillvalue=mpfr(0))
        return Polynomial(*(a + b for a, b in pairs))

    def __mul__(self, other: Any) -> Polynomial:
        if not isinstance(other, Polynomial):
            return Polynomial(*(c * other for c in self.coefficients))
        a, b = self.coefficients, other.coefficients
        product = [mpfr(0)] * (len(a) + len(b) - 1)
        for i, x in enumerate(a):
            for j, y in enumerate(b):
                product[i + j] += x * y
        return Polynomial(*product)

    def __pow__(self, exponent: int) -> Polynomial:
        return self if exponent == 1 else self * self ** (exponent - 1)

    def __neg__(self) -> Polynomial:
        return Polynomial(*(-c for c in self.coefficients))

    def __sub__(self, other: Any) -> Polynomial:
        return self + -other

    def __rsub__(self, other: Any) -> Polynomial:
        return -self + other

    __radd__, __rmul__ = __add__, __mul__

    def __call__(self, t: mpfr) -> mpfr:
        value = mpfr(0)
        for c in reversed(self.coefficients):
            value = value * t + c
        return value

    def derivative(self) -> Polynomial:
        return Polynomial(*(k * c for k, c in enumerate(self.coefficients) if k))

    def roots(self) -> list[mpfr]:
        """The t at which it is 0, in ascending order, a multiple one once; none for a constant.

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
        found = [turn for turn in turns if exact(turn) == 0]
        for low, high in pairwise([-end, *turns, end]):
            if exact(low) * exact(high) < 0:
                turn, side = (low, 1) if low in turns else (high, -1)
                found.append(exact.root(low, high, exact.beside(turn, side)))
        return sorted(found)

    def beside(self, turn: mpfr, side: int) -> mpfr:
        """The root, to one side of a turning point, of the parabola that it looks like there."""
        bend = self.derivative().derivative()(turn)
        square = -2 * self(turn) / bend if bend else mpfr(0)
        return turn + side * sqrt(square) if square > 0 else turn

    def root(self, low: mpfr, high: mpfr, t: mpfr) -> mpfr:
        """The root between places with different signs: by Newton's steps from t, by halves where these lead out or do
        not shrink."""
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


def coefficients_of(other: Any) -> list[mpfr]:
    """Those of a polynomial; a number is the only one."""
    return other.coefficients if isinstance(other, Polynomial) else [mpfr(other)]
