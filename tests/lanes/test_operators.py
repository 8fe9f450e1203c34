"""Every operator and verb on one and two numbers, compiled, against numpy bit for bit."""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numba import njit
from numba.extending import register_jitable

import minirt.lanes.compiled  # noqa: F401
from minirt import lanes
from minirt.lanes import lane, load, splat, unit_roundoff, where, width
from tests.lanes.numbers import PRECISIONS, assert_same, edges, pairs

Function = Callable[..., Any]

ARITHMETIC = (operator.add, operator.sub, operator.mul, operator.truediv)
COMPARISONS = (operator.lt, operator.le, operator.gt, operator.ge, operator.eq, operator.ne)
ONE = {lanes.sqrt: np.sqrt, lanes.fabs: np.fabs, lanes.floor: np.floor, operator.neg: np.negative}
TWO = {
    **{each: each for each in ARITHMETIC},
    lanes.copysign: np.copysign,
    lanes.minimum: lambda a, b: np.where(a < b, a, b),
    lanes.maximum: lambda a, b: np.where(a > b, a, b),
}


@register_jitable
def put(out: Any, start: int, x: Any) -> None:
    for ray in range(width(out)):
        out[start + ray] = lane(x, ray)


def compiled(function: Function, *given: Any) -> Any:
    """The function, compiled, on all lanes of arrays and on single numbers."""
    jitable = function if function in (*ARITHMETIC, *COMPARISONS, operator.neg) else register_jitable(function)
    verdict = function in COMPARISONS

    if len(given) == 1:

        def run(a: Any, out: Any) -> None:
            for i in range(0, out.size, width(out)):
                put(out, i, jitable(load(a, i)))
    elif np.ndim(given[1]) == 0:

        def run(a: Any, b: Any, out: Any) -> None:
            for i in range(0, out.size, width(out)):
                x = jitable(load(a, i), b)
                put(out, i, where(x, 1.0, 0.0) if verdict else x)
    elif np.ndim(given[0]) == 0:

        def run(a: Any, b: Any, out: Any) -> None:
            for i in range(0, out.size, width(out)):
                x = jitable(a, load(b, i))
                put(out, i, where(x, 1.0, 0.0) if verdict else x)
    else:

        def run(a: Any, b: Any, out: Any) -> None:
            for i in range(0, out.size, width(out)):
                x = jitable(load(a, i), load(b, i))
                put(out, i, where(x, 1.0, 0.0) if verdict else x)

    (array, *_) = (each for each in given if np.ndim(each))
    out = np.empty_like(array)
    njit(error_model="numpy")(run)(*given, out)
    return out


def on_numbers(function: Function, *given: Any) -> Any:
    """The function, compiled for single numbers, on each of them."""
    jitable = njit(error_model="numpy")(wrapped(function, len(given)))
    return np.array([jitable(*each) for each in zip(*given, strict=True)])


def wrapped(function: Function, count: int) -> Function:
    # numba compiles plain functions: one around the verb.
    return (lambda a: function(a)) if count == 1 else (lambda a, b: function(a, b))  # noqa: PLW0108


def name(function: Function) -> str:
    return function.__name__


@pytest.fixture(autouse=True)
def quiet() -> Any:
    with np.errstate(all="ignore"):
        yield


@PRECISIONS
@pytest.mark.parametrize("function", ONE, ids=name)
def test_of_one_number(function: Function, dtype: Any) -> None:
    numbers = edges(dtype)
    expected = ONE[function](numbers)
    assert_same(compiled(function, numbers), expected)
    interpreted = function(numbers)
    assert_same(interpreted, expected)
    assert interpreted.dtype == dtype
    if function is not operator.neg:
        assert_same(on_numbers(function, numbers), expected)


@PRECISIONS
@pytest.mark.parametrize("function", TWO, ids=name)
def test_of_two_numbers(function: Function, dtype: Any) -> None:
    first, second = pairs(dtype)
    expected = TWO[function](first, second)
    assert_same(compiled(function, first, second), expected)
    interpreted = function(first, second)
    assert_same(interpreted, expected)
    assert interpreted.dtype == dtype
    if function not in ARITHMETIC:
        assert_same(on_numbers(function, first, second), expected)


@PRECISIONS
@pytest.mark.parametrize("function", TWO, ids=name)
def test_of_lanes_and_a_single_number(function: Function, dtype: Any) -> None:
    # A single number takes the precision of the lanes beside it.
    numbers = edges(dtype)
    for single in (3, 0.1):
        assert_same(compiled(function, numbers, single), TWO[function](numbers, dtype(single)))
        assert_same(compiled(function, single, numbers), TWO[function](dtype(single), numbers))


@PRECISIONS
@pytest.mark.parametrize("function", COMPARISONS, ids=name)
def test_comparisons(function: Function, dtype: Any) -> None:
    first, second = pairs(dtype)
    assert_same(compiled(function, first, second), function(first, second).astype(dtype))
    numbers = edges(dtype)
    assert_same(compiled(function, numbers, 1.5), function(numbers, dtype(1.5)).astype(dtype))
    assert_same(compiled(function, 1, numbers), function(dtype(1), numbers).astype(dtype))


@PRECISIONS
def test_splat_and_load_at_any_index(dtype: Any) -> None:
    @njit(error_model="numpy")
    def run(a: Any, start: int, out: Any) -> None:
        x = load(a, start)
        put(out, 0, x)
        put(out, width(out), splat(a[1], x))
        put(out, 2 * width(out), splat(0.1, x))

    numbers = edges(dtype)
    count = width(numbers)
    for start in range(2):
        out = np.empty(3 * count, dtype)
        run(numbers, start, out)
        expected = [*numbers[start : start + count], *[numbers[1]] * count, *[dtype(0.1)] * count]
        assert_same(out, expected)
        x = load(numbers, start)
        assert_same([*x, *splat(numbers[1], x), *splat(0.1, x)], expected)
        assert splat(0.1, x).dtype == dtype


@PRECISIONS
def test_as_many_lanes_as_fill_two_registers(dtype: Any) -> None:
    @njit(error_model="numpy")
    def run(a: Any) -> Any:
        return width(a), width(load(a, 0)), unit_roundoff(load(a, 0)), unit_roundoff(a[0])

    numbers = edges(dtype)
    roundoff = {np.float64: 2.0**-53, np.float32: 2.0**-24}[dtype]
    expected = 128 // numbers.itemsize, 128 // numbers.itemsize, roundoff, roundoff
    assert run(numbers) == run.py_func(numbers) == expected
    assert dtype(1) + dtype(roundoff) == 1 < dtype(1) + dtype(1.01 * roundoff)


def test_what_is_loaded_does_not_change_with_the_array() -> None:
    values = np.arange(16.0)
    loaded = load(values, 0)
    values[:] = 0
    assert loaded.tolist() == list(range(16))
