"""Edge cases of floating-point arithmetic, and a comparison bit for bit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

DTYPES = (np.float64, np.float32)
PRECISIONS = pytest.mark.parametrize("dtype", DTYPES, ids=["f64x16", "f32x32"])


def edges(dtype: Any) -> Any:
    """Return zero, denormal, tiny, ordinary, whole, large and infinite numbers of both signs, and NaN, in packets."""
    kind = np.finfo(dtype)
    small, root = float(kind.tiny), float(kind.max) ** 0.5
    whole = 2.0 ** (kind.nmant - 1) + 0.5
    values = [0, kind.smallest_subnormal, 3 * float(kind.smallest_subnormal), small, 1 / root, 0.1, 0.5, 1, 1.5, 2.5, 3]
    values += [whole, root, float(kind.max) / 2, kind.max, np.inf, np.nan]
    signed = [sign * float(each) for each in values for sign in (1, -1)]
    return np.array([*signed, *np.linspace(-7.25, 9, -len(signed) % 32)], dtype)


def pairs(dtype: Any) -> tuple[Any, Any]:
    """Return two arrays that pair every number with every other."""
    first, second = np.meshgrid(edges(dtype), edges(dtype), indexing="ij")
    return first.ravel(), second.ravel()


def assert_same(actual: Any, expected: Any) -> None:
    """Assert that numbers are equal bit for bit, also the sign of 0; any NaN equals any other."""
    actual, expected = np.broadcast_arrays(np.asarray(actual), np.asarray(expected))
    nan = np.isnan(expected)
    assert np.array_equal(np.isnan(actual), nan)
    assert np.array_equal(actual[~nan], expected[~nan])
    assert np.array_equal(np.signbit(actual[~nan]), np.signbit(expected[~nan]))
