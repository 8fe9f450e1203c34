"""Arithmetic of the formulas of shapes: compensated, double-double, quadratic equations and frames."""

from __future__ import annotations

import operator
from collections.abc import Callable
from fractions import Fraction
from math import inf
from typing import Any

import numpy as np
import pytest
from gmpy2 import mpfr, sqrt
from numba import njit

from minirt.fields import unit
from minirt.kernel.compiler.pipeline import FLAGS
from minirt.lanes import Vec, product_error, rounded_product
from minirt.shapes.boundary import DoubleDouble, clamp, maximum, minimum
from minirt.shapes.compensated import (
    along,
    divided,
    minus,
    pair,
    pairs,
    plus,
    scalar_product,
    times,
    two_product,
    two_sum,
    value,
)
from minirt.shapes.frames import basis
from minirt.shapes.quadrics import exact_ends, negative_interval
from tests.oracle.numbers import BITS
from tests.shapes.execution_modes import U
from tests.shapes.regimes import random_directions

RANDOM = np.random.default_rng(1)
PAIRS = RANDOM.normal(size=(200, 2)) * 10.0 ** RANDOM.integers(-20, 20, (200, 2))


def test_a_sum_and_its_error_are_exact() -> None:
    for a, b in PAIRS:
        total, low = two_sum(a, b)
        assert Fraction(total) + Fraction(low) == Fraction(a) + Fraction(b)


def test_a_product_and_its_error_are_exact() -> None:
    for a, b in PAIRS:
        product, low = two_product(a, b)
        assert Fraction(product) + Fraction(low) == Fraction(a) * Fraction(b)


def test_compiled_sums_and_products_are_the_same() -> None:
    @njit(**FLAGS)
    def parts(a: float, b: float) -> tuple[float, float, float]:
        product = rounded_product(a, b)
        return product, product_error(a, b), product + 1.0  # the sum must not be fused with the product

    for a, b in PAIRS:
        assert parts(a, b) == (a * b, product_error(a, b), a * b + 1.0)


def test_pairs_have_twice_the_precision() -> None:
    for a, b in PAIRS:
        x, y = (a, a * 1e-17), (b, b * -2e-17)
        one, other = (Fraction(high) + Fraction(low) for high, low in (x, y))
        expected = (one + other, one - other, one * other, one / Fraction(b))
        for found, right in zip((plus(x, y), minus(x, y), times(x, y), divided(x, b)), expected, strict=True):
            scale = max(abs(right), abs(one), abs(other)) if found != times(x, y) else abs(right)
            assert abs(sum(map(Fraction, found)) - right) <= scale * Fraction(1, 2**100)


LOW_AXES = [(0.0, 1.0, 0.0), (0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, -1e-300, 1.0), (0.6, 0.8, 0.0)]
LOW_AXES += map(tuple, random_directions(np.random.default_rng(1), 50).tolist())


def test_an_axis_is_known_to_32_digits() -> None:
    for axis in LOW_AXES:
        w = pairs(Vec(*map(np.float64, axis)), np.float64(0))
        excess = 0.5 * value(minus(scalar_product(w, w), pair(1.0, 0.0, np.float64(0))))
        length = sqrt(sum(mpfr(part) ** 2 for part in axis))
        for one, exact in zip(np.eye(3), (mpfr(part) / length for part in axis), strict=True):
            high, low = along(pairs(Vec(*one), np.float64(0)), w, excess)
            assert abs(exact - mpfr(high) - mpfr(low)) <= 2.0**-103


EXACT = mpfr(2) ** -101  # relative error
COUNT = 200


def random_number(seed: int) -> DoubleDouble:
    """Numbers of all sizes and signs, whose low parts are as large as they may be."""
    random = np.random.default_rng(seed)
    high = random.normal(size=COUNT) * 10.0 ** random.uniform(-20, 20, COUNT)
    return DoubleDouble(high, 0.5 * random.uniform(-1, 1, COUNT) * np.spacing(high))


def exact(x: Any) -> list[mpfr]:
    """The numbers in 60 digits."""
    if isinstance(x, DoubleDouble):
        return [mpfr(float(high)) + mpfr(float(low)) for high, low in zip(x.high, x.low, strict=True)]
    return [mpfr(float(part)) for part in x]


@pytest.mark.parametrize("operation", [operator.add, operator.sub, operator.mul, operator.truediv])
@pytest.mark.parametrize("plain", [None, 0, 1])
def test_arithmetic(operation: Callable[[Any, Any], Any], plain: int | None) -> None:
    assert BITS > 2 * 101
    pair: list[Any] = [random_number(1), random_number(2)]
    if plain is not None:
        pair[plain] = pair[plain].high  # a float64
    found = exact(operation(*pair))
    for one, other, result in zip(*map(exact, pair), found, strict=True):
        right = operation(one, other)
        assert abs(result - right) <= EXACT * abs(right)


def test_roots_and_amounts() -> None:
    one = abs(random_number(4))
    assert (one.high > 0).all()
    for x, root in zip(*map(exact, (one, one.root())), strict=True):
        assert abs(root - sqrt(x)) <= EXACT * root
    nothing = DoubleDouble(np.array([0.0, -1e-40]), 0.0, Vec(1.0, 2.0, 3.0)).root()
    assert nothing.high.tolist() == [0, 0]
    assert nothing.slope.x.tolist() == [0, 0]
    power = np.full(COUNT, -800)
    assert np.array_equal(one.scaled(power).scaled(-power).high, one.high)


def test_the_greater_and_the_lesser_number_have_the_slope_of_that_number() -> None:
    low, high = DoubleDouble(np.array([-3.0]), 0.0, Vec(1, 2, 3)), DoubleDouble(np.array([5.0]), 0.0, Vec(4, 5, 6))
    for x, y in ((low, high), (high, low)):
        assert [(found.high, found.slope.x, found.slope.z) for found in (minimum(x, y), maximum(x, y))] == [
            (-3, 1, 3),
            (5, 4, 6),
        ]
    for x, expected in ((-9.0, (-3, 0)), (4.0, (4, 1)), (9.0, (5, 0))):
        found = clamp(DoubleDouble(np.array([x]), 0.0, Vec(1, 1, 1)), -3.0, 5.0)
        assert (found.high, found.slope.y) == expected


CASES = [
    ((1, 0, -4), (True, -2, 2)),
    ((1, -3, 8), (True, 2, 4)),
    ((1, 3, 8), (True, -4, -2)),
    ((1, 0, 4), (False, None, None)),  # never below zero
    ((1, 0, 0), (True, 0, 0)),  # touches it at 0
    ((0, 0, -1), (True, -inf, np.nan)),  # a constant below zero: a ray along the axis, inside
    ((0, 0, 0), (True, -inf, np.nan)),
    ((0, 0, 1), (True, inf, np.nan)),  # and one above zero
    ((0, 3, 6), (True, -inf, -1)),  # a line
    ((0, -3, 6), (True, 1, inf)),
    ((1, 1e8, 1), (True, -2e8, -5e-9)),  # the small root, which the formula of school loses
    ((1, -1e8, 1), (True, 5e-9, 2e8)),
    ((-1, 0, 4), (True, 2, -2)),  # below zero again after the second root
    ((-1, 3, -8), (True, 4, 2)),
    ((-1, -3, -8), (True, -2, -4)),
    ((-1, 0, -4), (False, None, None)),
    ((-1, 0, 0), (True, 0, 0)),
    ((np.nan, 1, 1), (False, None, None)),
    ((1, np.nan, 1), (False, None, None)),
    ((1, 1, np.nan), (False, None, None)),
]


def solved(a: Any, b: Any, c: Any) -> tuple[Any, Any]:
    return negative_interval(a, 1 / a, b, c, np.float64(0))


def solved_in_pairs(a: Any, b: Any, c: Any) -> tuple[Any, Any]:
    zero = np.float64(0)
    return exact_ends((a, zero), (b, zero), (c, zero), np.False_, zero)[:2]


@pytest.mark.parametrize("solve", [solved, solved_in_pairs])
@pytest.mark.parametrize(("coefficients", "expected"), CASES)
def test_where_a_quadratic_is_below_zero(
    coefficients: tuple[float, ...], expected: tuple[object, ...], solve: Callable[..., tuple[Any, Any]]
) -> None:
    with np.errstate(all="ignore"):
        below, above = solve(*map(np.float64, coefficients))
    if expected[0]:
        assert (below, above) == pytest.approx(expected[1:], rel=4e-16, abs=0, nan_ok=True)
    else:
        assert np.isnan(below)
        assert np.isnan(above)


@pytest.mark.parametrize(("b", "other"), [(3.0, -6.0), (-3.0, 6.0)])
@pytest.mark.parametrize("c", [1e-17, -1e-17])
def test_the_end_at_which_a_line_starts_is_exactly_zero_and_the_other_one_stays(
    b: float, other: float, c: float
) -> None:
    one, half, level, zero = map(np.float64, (1.0, b, c, 0.0))
    *ends, near = exact_ends((one, zero), (half, zero), (level, zero), np.True_, np.float64(1e-32))
    assert sorted(ends) == sorted((0.0, other))
    assert near == pytest.approx(-c / (2 * b))


@pytest.mark.parametrize(("a", "ends"), [(-1.0, (np.nan, np.nan)), (1.0, (0.0, 0.0)), (0.0, (inf, inf))])
def test_a_line_that_touches_where_it_starts_has_both_ends_there(a: float, ends: tuple[float, float]) -> None:
    """A steep one, which is below the surface outside of an interval, stays below it."""
    square, half, level, zero = map(np.float64, (a, 1e-17, -1e-30, 0.0))
    with np.errstate(all="ignore"):
        below, above, _ = exact_ends((square, zero), (half, zero), (level, zero), np.True_, np.float64(1e-32))
    assert np.array_equal(below, ends[0], equal_nan=True)
    assert np.array_equal(above, ends[1], equal_nan=True) or a == 0.0


POLES = [(0, 0, 1), (0, 0, -1), (1e-300, 0, -1), (1e-8, 1e-9, -1), (0, 1e-17, -1), (1, 0, -0.0), (0, 1, 0.0)]
AXES = [*map(unit, POLES), *map(tuple, random_directions(np.random.default_rng(1), 200))]


def test_axes_have_orthonormal_right_handed_bases() -> None:
    for axis in AXES:
        u, v, w = (np.array([each.x, each.y, each.z]) for each in basis(axis))
        assert tuple(w) == axis
        frame = np.array([u, v, w])
        assert np.abs(frame @ frame.T - np.eye(3)).max() <= 8 * U, axis
        assert np.abs(np.cross(u, v) - w).max() <= 8 * U, axis
