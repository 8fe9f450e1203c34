"""One number of many: the greatest of all rays, and the lowest bit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numba import njit

import minirt.lanes.compiled  # noqa: F401
from minirt.lanes import greatest, load, lowest
from tests.lanes.numbers import PRECISIONS, edges


@njit(error_model="numpy")
def top(values: Any) -> float:
    return greatest(load(values, 0))


@njit
def low(number: int) -> int:
    return lowest(number)


@PRECISIONS
@pytest.mark.parametrize("interpreted", [False, True])
def test_the_greatest_may_be_in_any_lane_beside_any_number(interpreted: bool, dtype: Any) -> None:
    count = 128 // np.dtype(dtype).itemsize
    ask = top.py_func if interpreted else top
    for lane in range(count):
        for each in edges(dtype):
            values = np.full(count, each, dtype)
            values[lane] = 2.5
            expected = 2.5 if np.isnan(each) else max(2.5, float(each))
            assert ask(values) == expected
    assert ask(np.arange(count, dtype=dtype)) == count - 1
    assert ask(-np.arange(count, dtype=dtype)) == 0
    assert ask(np.full(count, np.nan, dtype)) == -np.inf


@pytest.mark.parametrize("interpreted", [False, True])
def test_the_lowest_bit(interpreted: bool) -> None:
    ask = low.py_func if interpreted else low
    for bit in range(62):
        assert ask(1 << bit) == bit
        assert ask((1 << bit) | (1 << 62)) == bit
