"""Double-double numbers against 60-digit arithmetic, and their gradients against derivatives known by hand."""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from gmpy2 import mpfr, sqrt

from minirt.lanes import Vec, dot
from minirt.shapes.boundary import DoubleDouble
from tests.oracle.body import BITS
from tests.shapes.regimes import Array

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


def test_sums_that_cancel_are_exact() -> None:
    one = random_number(3)
    for moved in (one * (1.0 + 2.0**-40), DoubleDouble(one.high, -one.low)):
        for a, b, result in zip(*map(exact, (one, moved, one - moved)), strict=True):
            assert abs(result - (a - b)) <= EXACT * abs(a - b)


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


def test_gradients() -> None:
    """x^2 y / z, sqrt(x y + z^2) and |-z|, at random points."""
    x, y, z = np.random.default_rng(5).uniform(1, 2, (3, COUNT))
    axes = (Vec(1.0, 0.0, 0.0), Vec(0.0, 1.0, 0.0), Vec(0.0, 0.0, 1.0))
    a, b, c = (DoubleDouble(part, 0.0, axis) for part, axis in zip((x, y, z), axes, strict=True))
    root = np.sqrt(x * y + z * z)
    cases = [
        (a * a * b / c, (2 * x * y / z, x * x / z, -x * x * y / z**2)),
        ((a * b + c * c).root(), (y / root / 2, x / root / 2, z / root)),
        (abs(-c), (0 * x, 0 * x, 0 * x + 1)),
        (dot(Vec(a, b, c), Vec(b, 2.0, x)) - 1.0, (y, x + 2, x)),
    ]
    for number, right in cases:
        found = (number.slope.x, number.slope.y, number.slope.z)
        assert all(close(one, other) for one, other in zip(found, right, strict=True))


def close(found: Array, right: Array) -> bool:
    return bool(np.allclose(found, right, rtol=1e-14, atol=0))
