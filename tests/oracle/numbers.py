"""Numbers in which the oracle computes `boundary`: arrays of 106 or of 203 bits, polynomials of t, and their roots."""

from __future__ import annotations

from itertools import count, pairwise
from typing import Any

import numpy as np
from gmpy2 import get_context, mpfr, sqrt
from numpy.typing import NDArray

from minirt.lanes import Vec
from minirt.shapes.boundary import NO_SLOPE, DoubleDouble

Array = NDArray[np.float64]
BITS = 203  # of precision, 60 digits: MPFR, in a seventh of the time of Python's decimal
get_context().precision = BITS
in_digits, root_of = np.frompyfunc(mpfr, 1, 1), np.frompyfunc(sqrt, 1, 1)


class Number:
    """An array of numbers: a `DoubleDouble` for many rays at once, or mpfr numbers for a second look at a few."""

    __array_ufunc__ = None
    __slots__ = ("value",)

    def __init__(self, value: Any) -> None:
        self.value = value

    @property
    def high(self) -> Array:
        """The numbers, rounded to float64."""
        return np.asarray(self.value.high if isinstance(self.value, DoubleDouble) else self.value, np.float64)

    @property
    def slope(self) -> Vec:
        """The gradient, where there is one."""
        return self.value.slope if isinstance(self.value, DoubleDouble) else NO_SLOPE

    @slope.setter
    def slope(self, slope: Vec) -> None:
        if isinstance(self.value, DoubleDouble):
            self.value.slope = slope

    def __add__(self, other: Any) -> Any:
        return NotImplemented if isinstance(other, Along) else Number(self.value + value_of(other))

    def __mul__(self, other: Any) -> Any:
        return NotImplemented if isinstance(other, Along | Vec) else Number(self.value * value_of(other))

    def __truediv__(self, other: Any) -> Number:
        return Number(self.value / value_of(other))

    def __rtruediv__(self, other: Any) -> Number:
        return Number(other / self.value)

    def __neg__(self) -> Number:
        return Number(-self.value)

    def __sub__(self, other: Any) -> Any:
        return self + -other

    def __rsub__(self, other: Any) -> Any:
        return -self + other

    def __abs__(self) -> Number:
        return Number(abs(self.value))

    __radd__, __rmul__ = __add__, __mul__

    def root(self) -> Number:
        if isinstance(self.value, DoubleDouble):
            return Number(self.value.root())
        return Number(root_of(np.where(self.high > 0.0, self.value, mpfr(0))))

    def scaled(self, power: Any) -> Number:
        if isinstance(self.value, DoubleDouble):
            return Number(self.value.scaled(power))
        return Number(self.value * in_digits(np.ldexp(1.0, power)))

    def where(self, mask: Any, other: float = np.nan) -> Number:
        """The numbers where the mask is true, elsewhere the other one."""
        if isinstance(self.value, DoubleDouble):
            return Number(DoubleDouble(np.where(mask, self.value.high, other), np.where(mask, self.value.low, 0.0)))
        return Number(np.where(mask, self.value, mpfr(other)))


def value_of(x: Any) -> Any:
    return x.value if isinstance(x, Number) else x


Polynomial = list[Any]  # coefficients of 1, t, t^2, ...
Surd = dict[frozenset[int], Polynomial]  # sum of polynomials, each times the square roots with these indices
INDEX = count()
ROOTS: dict[int, Surd] = {}  # what each is the root of


class Along:
    """A function of t for each ray: of polynomials, their square roots and the branches of absolute values.

    Each absolute value has two branches, and so a function with k of them has up to 2^k.
    """

    __array_ufunc__ = None
    high = np.array(np.nan)  # no single number

    def __init__(self, branches: dict[frozenset[int], Surd]) -> None:
        self.branches = branches  # by the signed numbers of the branches taken

    def __add__(self, other: Any) -> Along:
        if not isinstance(other, Along):
            other = constant(other)
        return self.joined(other, add)

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, Vec):
            return NotImplemented
        return self.joined(other if isinstance(other, Along) else constant(other), multiply)

    def joined(self, other: Along, operation: Any) -> Along:
        pairs = ((i, j, x, y) for i, x in self.branches.items() for j, y in other.branches.items())
        return Along({i | j: operation(x, y) for i, j, x, y in pairs if not any(-branch in j for branch in i)})

    def __truediv__(self, other: Any) -> Any:
        return self * (1.0 / other)

    def __neg__(self) -> Along:
        return self * -1.0

    def __sub__(self, other: Any) -> Any:
        return self + -other

    def __rsub__(self, other: Any) -> Any:
        return -self + other

    __radd__, __rmul__ = __add__, __mul__

    def __abs__(self) -> Along:
        branch = next(INDEX) + 1
        opposite = (-self).branches
        return Along(
            {i | {sign * branch}: x for sign, of in ((1, self.branches), (-1, opposite)) for i, x in of.items()}
        )

    def root(self) -> Along:
        found = {}
        for branch, surd in self.branches.items():
            index = next(INDEX)
            ROOTS[index] = surd
            found[branch] = {frozenset({index}): [1.0]}
        return Along(found)

    def zeros(self) -> list[Number]:
        """All t at which one of the branches may be 0 with some signs of its square roots, NaN where there are none."""
        polynomials = [without_roots(surd) for surd in self.branches.values()]
        nothing = next(c for p in polynomials for c in p if isinstance(c, Number)) * 0.0
        return [t for p in polynomials for t in roots([nothing + c for c in p])]


def constant(x: Any) -> Along:
    return Along({frozenset(): {frozenset(): [x]}})


def add(x: Surd, y: Surd) -> Surd:
    found = dict(x)
    for roots_of, polynomial in y.items():
        found[roots_of] = added(found[roots_of], polynomial) if roots_of in found else polynomial
    return found


def added(p: Polynomial, q: Polynomial) -> Polynomial:
    longer, shorter = (p, q) if len(p) >= len(q) else (q, p)
    return [a + b for a, b in zip(longer, shorter, strict=False)] + longer[len(shorter) :]


def multiply(x: Surd, y: Surd) -> Surd:
    found: Surd = {}
    for one, p in x.items():
        for other, q in y.items():
            term: Surd = {one ^ other: multiplied(p, q)}
            for index in one & other:
                term = multiply(term, ROOTS[index])
            found = add(found, term)
    return found


def multiplied(p: Polynomial, q: Polynomial) -> Polynomial:
    product = [0.0] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            product[i + j] = a * b + product[i + j]
    return product


def without_roots(surd: Surd) -> Polynomial:
    """A polynomial that is 0 wherever the function is: for each square root s, a + b s is multiplied by a - b s."""
    while indices := [index for key in surd for index in key]:
        last = max(indices)
        a = {key: p for key, p in surd.items() if last not in key}
        b = {key - {last}: p for key, p in surd.items() if last in key}
        surd = add(multiply(a, a), negative(multiply(multiply(b, b), ROOTS[last])))
    return surd[frozenset()]


def negative(surd: Surd) -> Surd:
    return {key: [-1.0 * c for c in p] for key, p in surd.items()}


def roots(c: Polynomial) -> list[Number]:
    """The real roots, in no order; those that are not there are NaN."""
    degree = len(c) - 1
    if degree < 1:
        return []
    if degree == 1:
        return [-c[0] / c[1]]
    return of_quadratic(*c) if degree == 2 else between_turns(c)


def of_quadratic(c: Number, b: Number, a: Number) -> list[Number]:
    b = b * 0.5
    D = b * b - a * c
    q = -(b + D.root() * np.where(b.high < 0, -1.0, 1.0))
    real = D.high >= -(2.0**-96) * (b.high * b.high + np.abs(a.high * c.high))
    straight = np.abs(a.high) <= 2.0**-98 * np.abs(c.high)
    return [(q / a).where(real & ~straight), (c / q).where(real)]


BISECTIONS = 58  # leave a root to the last bits of float64


def between_turns(c: Polynomial) -> list[Number]:
    """Return one root of a cubic or more between two turning points with different signs."""
    slope = [k * each for k, each in enumerate(c) if k]
    turns = np.sort(np.stack(np.broadcast_arrays(*(turn.high for turn in roots(slope)))), axis=0)  # NaN come last
    highs = [np.asarray(each.high) for each in c]
    shares = [(np.abs(each) / np.abs(highs[-1])) ** (1 / (len(c) - 1 - k)) for k, each in enumerate(highs[:-1])]
    # All roots lie within twice the largest |a[n-k] / a[n]|^(1/k) (Fujiwara 1916).
    end = np.asarray(4 * np.maximum.reduce(np.broadcast_arrays(*shares)))
    found = []
    for ends in pairwise([-end, *np.where(np.isnan(turns), end, turns), end]):
        low, high = ends
        below = at(c, low).high
        crosses = (below * at(c, high).high <= 0) & (low < high)
        for _ in range(BISECTIONS):
            t = 0.5 * (low + high)
            before = at(highs, t) * below > 0
            low, high = np.where(before, t, low), np.where(before, high, t)
        exact = c[0] * 0.0 + 0.5 * (low + high)
        for _ in range(3):
            step = at(c, exact) / at(slope, exact)
            fine = np.abs(step.high) <= 2.0**-20 * end
            exact = exact - step.where(fine, 0.0)
        found.append(exact.where(crosses))
    return found


def at(c: Polynomial, t: Any) -> Any:
    value = c[-1]
    for each in reversed(c[:-1]):
        value = value * t + each
    return value
