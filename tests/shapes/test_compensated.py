"""Compensated sums and products, against rational numbers."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from numba import njit

import minirt.kernel.compiler.object_code  # noqa: F401  (registers what is compiled)
from minirt.kernel.compiler.pipeline import FLAGS
from minirt.lanes import Vec, product_error, rounded_product
from minirt.shapes.compensated import divided, minus, plus, power_of_point, times, two_product, two_sum

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


def test_compiled_a_product_that_is_used_once_is_not_fused_with_the_sum() -> None:
    @njit(**FLAGS)
    def rest(a: float, b: float, product: float) -> float:
        return rounded_product(a, b) - product

    assert all(rest(a, b, a * b) == 0 for a, b in PAIRS)


def test_the_power_of_a_point_is_exact_near_the_surface() -> None:
    for exponent in range(-6, 4):
        x, y, z = RANDOM.normal(size=3)
        point = np.array([x, y, z]) + np.array([0.6, 0.8, 0.0]) * (5e8 + 10.0**exponent)
        squares = sum((Fraction(a) - Fraction(b)) ** 2 for a, b in zip(point, (x, y, z), strict=True))
        right = squares - Fraction(5e8) ** 2
        found = power_of_point(Vec(*point), Vec(x, y, z), np.float64(5e8))
        assert abs(Fraction(found) - right) <= abs(right) * Fraction(1, 2**50)


def test_pairs_have_twice_the_precision() -> None:
    for a, b in PAIRS:
        x, y = (a, a * 1e-17), (b, b * -2e-17)
        one, other = (Fraction(high) + Fraction(low) for high, low in (x, y))
        expected = (one + other, one - other, one * other, one / Fraction(b))
        for found, right in zip((plus(x, y), minus(x, y), times(x, y), divided(x, b, 1 / b)), expected, strict=True):
            scale = max(abs(right), abs(one), abs(other)) if found != times(x, y) else abs(right)
            assert abs(sum(map(Fraction, found)) - right) <= scale * Fraction(1, 2**100)
