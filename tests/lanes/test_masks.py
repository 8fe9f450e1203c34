"""Masks, compiled: their logic, and what is asked of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numba import njit

import minirt.lanes.compiled  # noqa: F401
from minirt.lanes import WIDTH, Vec, any, first, load, where
from tests.lanes.numbers import NUMBERS, assert_same
from tests.lanes.test_operators import put

TRUTHS = [np.array([bits >> ray & 1 for ray in range(WIDTH)], float) for bits in range(2**WIDTH)]


@njit(error_model="numpy")
def logic(a: Any, b: Any, out: Any) -> None:
    p, q = load(a, 0) > 0.5, load(b, 0) > 0.5
    put(out, 0, where(p & q, 1.0, 0.0))
    put(out, 8, where(p | q, 1.0, 0.0))
    put(out, 16, where(p ^ q, 1.0, 0.0))
    put(out, 24, where(~p, 1.0, 0.0))


@njit(error_model="numpy")
def asked(a: Any) -> tuple[bool, int]:
    mask = load(a, 0) > 0.5
    return any(mask), first(mask) if any(mask) else -1


def test_logic() -> None:
    out = np.empty(4 * WIDTH)
    for a in TRUTHS[::5]:
        for b in TRUTHS[::7]:
            logic(a, b, out)
            assert_same(out.reshape(4, WIDTH), [a * b, np.maximum(a, b), a != b, 1 - a])


@pytest.mark.parametrize("interpreted", [False, True])
def test_any_and_first(interpreted: bool) -> None:
    for truths in TRUTHS:
        found = [ray for ray in range(WIDTH) if truths[ray]]
        answer = (asked.py_func if interpreted else asked)(truths)
        assert answer == (bool(found), found[0] if found else -1)


@njit(error_model="numpy")
def choices(truths: Any, a: Any, b: Any, single: float, truth: bool, out: Any) -> None:
    mask = load(truths, 0) > 0.5
    x, y = load(a, 0), load(b, 0)
    put(out, 0, where(mask, x, y))
    put(out, 8, where(mask, single, y))
    put(out, 16, where(mask, x, single))
    put(out, 24, where(mask, single, 1))
    put(out, 32, where(truth, x, y))
    put(out, 40, where(truth, single, y))
    put(out, 48, where(mask, where(truth, single, 2), y))


@pytest.mark.parametrize("truth", [True, False])
def test_where(truth: bool) -> None:
    a, b, out = NUMBERS[-8:], NUMBERS[-18:-10], np.empty(7 * WIDTH)  # NaN and infinity among them
    for truths in TRUTHS[::3]:
        expected = [
            np.where(truths, a, b),
            np.where(truths, 0.1, b),
            np.where(truths, a, 0.1),
            np.where(truths, 0.1, 1),
            a if truth else b,
            np.full(8, 0.1) if truth else b,
            np.where(truths, 0.1 if truth else 2, b),
        ]
        choices(truths, a, b, 0.1, truth, out)
        assert_same(out.reshape(7, WIDTH), expected)


@njit(error_model="numpy")
def vectors(truths: Any, a: Any, b: Any, out: Any) -> None:
    mask = load(truths, 0) > 0.5
    lanes = Vec(load(a, 0), load(a, 8), load(a, 16))
    one = Vec(1, 2.0, 3.0)
    for row, v in (
        (0, where(mask, lanes, Vec(load(b, 0), load(b, 8), load(b, 16)))),
        (24, where(mask, one, lanes)),
        (48, where(mask, lanes, one)),
        (72, where(mask, one, -one)),
    ):
        put(out, row, v.x)
        put(out, row + 8, v.y)
        put(out, row + 16, v.z)


def test_where_on_vecs() -> None:
    a, b, out = NUMBERS[:24], NUMBERS[8:32], np.empty(96)
    one = np.repeat([1.0, 2.0, 3.0], 8)
    for truths in TRUTHS[::3]:
        vectors(truths, a, b, out)
        mask = np.tile(truths, 3)
        expected = [np.where(mask, x, y) for x, y in ((a, b), (one, a), (a, one), (one, -one))]
        assert_same(out.reshape(4, 24), expected)
        mask = truths > 0.5
        chosen = where(mask, Vec(a[:8], a[8:16], a[16:]), Vec(1.0, 2.0, 3.0))
        assert_same([chosen.x, chosen.y, chosen.z], expected[2].reshape(3, 8))
