"""Polynomials in one variable with multiple-precision coefficients, and their real roots."""

from __future__ import annotations

from itertools import pairwise, zip_longest
from typing import Any

from gmpy2 import mpfr, sqrt

from tests.oracle.vectors import BITS

EPS = mpfr(2) ** (1 - BITS)  # distance from 1 to the next number
STEPS = 1000  # of Newton's method at most; most roots take less than ten


class Polynomial:
    """The polynomial c0 + c1 t + c2 t^2 + ...

    It can be added to and multiplied with polynomials and numbers, so that a function written for numbers is expanded
    by calling it with polynomials.
    """

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


def coefficients_of(other: Any) -> list[mpfr]:
    """The coefficients of a polynomial, or of a number as a constant polynomial."""
    return other.coefficients if isinstance(other, Polynomial) else [mpfr(other)]
