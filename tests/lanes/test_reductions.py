"""Reductions to one number: the greatest of all lanes, and the lowest bit of an integer."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numba import njit

import minirt.lanes.compiled  # noqa: F401
from minirt.lanes import greatest, load, lowest
from tests.lanes.numbers import PRECISIONS, edges


@njit(error_model="numpy")
def greatest_of(values: Any) -> float:
    return greatest(load(values, 0))


@njit
def lowest_bit(number: int) -> int:
    return lowest(number)


@PRECISIONS
@pytest.mark.parametrize("interpreted", [False, True])
def test_the_greatest_number_is_found_in_any_lane(interpreted: bool, dtype: Any) -> None:
    count = 128 // np.dtype(dtype).itemsize
    function = greatest_of.py_func if interpreted else greatest_of
    for lane in range(count):
        for each in edges(dtype):
            values = np.full(count, each, dtype)
            values[lane] = 2.5
            expected = 2.5 if np.isnan(each) else max(2.5, float(each))
            assert function(values) == expected
    assert function(np.arange(count, dtype=dtype)) == count - 1
    assert function(-np.arange(count, dtype=dtype)) == 0
    assert function(np.full(count, np.nan, dtype)) == -np.inf


@pytest.mark.parametrize("interpreted", [False, True])
def test_the_lowest_bit_is_found(interpreted: bool) -> None:
    function = lowest_bit.py_func if interpreted else lowest_bit
    for bit in range(62):
        assert function(1 << bit) == bit
        assert function((1 << bit) | (1 << 62)) == bit
