"""Roots of quadratic equations, in the special cases."""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np
import pytest

from minirt.shapes.start import negative_interval

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


def solved(a: Any, b: Any, c: Any) -> tuple[Any, Any, Any]:
    return negative_interval(a, 1 / a, b, c, c)


@pytest.mark.parametrize(("coefficients", "expected"), CASES)
def test_where_a_quadratic_is_below_zero(coefficients: tuple[float, ...], expected: tuple[object, ...]) -> None:
    with np.errstate(all="ignore"):
        met, below, above = solved(*map(np.float64, coefficients))
    assert met == expected[0]
    if met:
        assert (below, above) == pytest.approx(expected[1:], rel=4e-16, abs=0, nan_ok=True)
    else:
        assert np.isnan(below)
        assert np.isnan(above)


def test_many_quadratics_at_once() -> None:
    with np.errstate(all="ignore"):
        met, below, above = solved(*np.array([coefficients for coefficients, _ in CASES], float).T)
    assert met.tolist() == [expected[0] for _, expected in CASES]
    assert list(zip(below[met], above[met], strict=True)) == [
        pytest.approx(expected[1:], rel=4e-16, abs=0, nan_ok=True) for _, expected in CASES if expected[0]
    ]
    assert np.isnan(below[~met]).all()
    assert np.isnan(above[~met]).all()


def test_a_root_that_is_only_rounding_is_exactly_zero_and_the_other_one_stays() -> None:
    for b, other in ((3.0, -6.0), (-3.0, 6.0)):
        for c in (1e-17, -1e-17):
            met, below, above = negative_interval(*map(np.float64, (1, 1, b, c, 0)))
            assert met
            assert sorted((below, above)) == sorted((0.0, other))
