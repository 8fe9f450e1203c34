"""Masks: logic, reduction to any and first, and selection by them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numba import njit

import minirt.lanes.compiled  # noqa: F401
from minirt.lanes import Vec, any, first, load, where, width
from tests.lanes.numbers import PRECISIONS, assert_same, edges
from tests.lanes.test_operators import store


def mask_values(dtype: Any) -> list[Any]:
    """Return masks as 0 and 1: no ray, all, each ray alone, all but one, neighbours, and some at random."""
    count = 128 // np.dtype(dtype).itemsize
    alone = np.eye(count)
    some = np.random.default_rng(1).integers(0, 2, (12, count))
    return list(
        np.concatenate([np.zeros((1, count)), alone, 1 - alone, alone + np.roll(alone, 1, axis=1), some]).astype(dtype)
    )


@njit(error_model="numpy")
def logic(a: Any, b: Any, out: Any) -> None:
    p, q = load(a, 0) > 0.5, load(b, 0) > 0.5
    truth = b[0] > 0.5
    for row, mask in enumerate((p & q, p | q, p ^ q, ~p, p & truth, truth | p, truth ^ p)):
        store(out[row], 0, where(mask, 1.0, 0.0))


@njit(error_model="numpy")
def any_and_first(a: Any) -> tuple[bool, int]:
    mask = load(a, 0) > 0.5
    return any(mask), first(mask) if any(mask) else -1


@PRECISIONS
def test_logic_is_that_of_truth_values(dtype: Any) -> None:
    out = np.empty((7, mask_values(dtype)[0].size), dtype)
    for a in mask_values(dtype)[::5]:
        for b in mask_values(dtype)[::7]:
            logic(a, b, out)
            assert_same(out[:4], [a * b, np.maximum(a, b), a != b, 1 - a])
            assert_same(out[4:], [a * b[0], np.maximum(a, b[0]), a != b[0]])


@PRECISIONS
@pytest.mark.parametrize("interpreted", [False, True])
def test_any_and_first_are_found(interpreted: bool, dtype: Any) -> None:
    for each in mask_values(dtype):
        true = np.flatnonzero(each)
        answer = (any_and_first.py_func if interpreted else any_and_first)(each)
        assert answer == (true.size > 0, true[0] if true.size else -1)


@njit(error_model="numpy")
def selections(mask_values: Any, a: Any, b: Any, single: float, truth: bool, out: Any) -> None:
    mask = load(mask_values, 0) > 0.5
    x, y = load(a, 0), load(b, 0)
    store(out[0], 0, where(mask, x, y))
    store(out[1], 0, where(mask, single, y))
    store(out[2], 0, where(mask, x, single))
    store(out[3], 0, where(mask, single, 1))
    store(out[4], 0, where(truth, x, y))
    store(out[5], 0, where(truth, single, y))
    store(out[6], 0, where(mask, where(truth, single, 2), y))


@PRECISIONS
@pytest.mark.parametrize("truth", [True, False])
def test_where_selects_lanes_and_single_numbers(truth: bool, dtype: Any) -> None:
    count = 128 // np.dtype(dtype).itemsize
    a, b, out = edges(dtype)[:count], edges(dtype)[-count:], np.empty((7, count), dtype)
    tenth = dtype(0.1)
    for each in mask_values(dtype)[::3]:
        mask = each > 0.5
        expected = [
            np.where(mask, a, b),
            np.where(mask, tenth, b),
            np.where(mask, a, tenth),
            np.where(mask, tenth, 1),
            a if truth else b,
            np.full(count, tenth) if truth else b,
            np.where(mask, tenth if truth else 2, b),
        ]
        selections(each, a, b, 0.1, truth, out)
        for actual, right in zip(out, expected, strict=True):
            assert_same(actual, right)


@njit(error_model="numpy")
def selected_vecs(mask_values: Any, a: Any, b: Any, out: Any) -> None:
    mask = load(mask_values, 0) > 0.5
    n = width(mask_values)
    lanes = Vec(load(a, 0), load(a, n), load(a, 2 * n))
    one = Vec(1, 2.0, 3.0)
    chosen = (
        where(mask, lanes, Vec(load(b, 0), load(b, n), load(b, 2 * n))),
        where(mask, one, lanes),
        where(mask, lanes, one),
        where(mask, one, -one),
    )
    for row, v in enumerate(chosen):
        store(out[row], 0, v.x)
        store(out[row], n, v.y)
        store(out[row], 2 * n, v.z)


@PRECISIONS
def test_where_selects_vecs(dtype: Any) -> None:
    count = 128 // np.dtype(dtype).itemsize
    a = np.resize(edges(dtype), 3 * count)
    b, out = a[::-1].copy(), np.empty((4, 3 * count), dtype)
    one = np.repeat(np.array([1.0, 2.0, 3.0], dtype), count)
    for each in mask_values(dtype)[::3]:
        selected_vecs(each, a, b, out)
        mask = np.tile(each, 3) > 0.5
        expected = [np.where(mask, x, y) for x, y in ((a, b), (one, a), (a, one), (one, -one))]
        assert_same(out, expected)
        chosen = where(each > 0.5, Vec(*a.reshape(3, count)), Vec(1.0, 2.0, 3.0))
        assert_same([chosen.x, chosen.y, chosen.z], expected[2].reshape(3, count))
