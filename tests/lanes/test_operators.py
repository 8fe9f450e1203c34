"""Operators and operations on one and two numbers, compiled and interpreted: as numpy, bit for bit."""

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
def store(out: Any, start: int, x: Any) -> None:
    """Store lanes in an array, lane by lane."""
    for ray in range(width(out)):
        out[start + ray] = lane(x, ray)


def compiled(function: Function, *arguments: Any) -> Any:
    """Call a function, compiled, on lanes of arrays and on single numbers."""
    jitable = function if function in (*ARITHMETIC, *COMPARISONS, operator.neg) else register_jitable(function)
    is_comparison = function in COMPARISONS

    if len(arguments) == 1:

        def run(a: Any, out: Any) -> None:
            for i in range(0, out.size, width(out)):
                store(out, i, jitable(load(a, i)))
    elif np.ndim(arguments[1]) == 0:

        def run(a: Any, b: Any, out: Any) -> None:
            for i in range(0, out.size, width(out)):
                x = jitable(load(a, i), b)
                store(out, i, where(x, 1.0, 0.0) if is_comparison else x)
    elif np.ndim(arguments[0]) == 0:

        def run(a: Any, b: Any, out: Any) -> None:
            for i in range(0, out.size, width(out)):
                x = jitable(a, load(b, i))
                store(out, i, where(x, 1.0, 0.0) if is_comparison else x)
    else:

        def run(a: Any, b: Any, out: Any) -> None:
            for i in range(0, out.size, width(out)):
                x = jitable(load(a, i), load(b, i))
                store(out, i, where(x, 1.0, 0.0) if is_comparison else x)

    (array, *_) = (each for each in arguments if np.ndim(each))
    out = np.empty_like(array)
    njit(error_model="numpy")(run)(*arguments, out)
    return out


def on_numbers(function: Function, *arguments: Any) -> Any:
    """Call a function, compiled for single numbers, on each number of arrays."""
    jitable = njit(error_model="numpy")(wrapped(function, len(arguments)))
    return np.array([jitable(*each) for each in zip(*arguments, strict=True)])


def wrapped(function: Function, count: int) -> Function:
    # numba compiles plain functions: one that calls the operation.
    return (lambda a: function(a)) if count == 1 else (lambda a, b: function(a, b))  # noqa: PLW0108


def name(function: Function) -> str:
    return function.__name__


@pytest.fixture(autouse=True)
def quiet() -> Any:
    """Let numpy divide by zero and overflow without warnings."""
    with np.errstate(all="ignore"):
        yield


@PRECISIONS
@pytest.mark.parametrize("function", ONE, ids=name)
def test_functions_of_one_number(function: Function, dtype: Any) -> None:
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
def test_functions_of_two_numbers(function: Function, dtype: Any) -> None:
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
def test_a_single_number_takes_the_precision_of_the_lanes_beside_it(function: Function, dtype: Any) -> None:
    numbers = edges(dtype)
    for single in (3, 0.1):
        assert_same(compiled(function, numbers, single), TWO[function](numbers, dtype(single)))
        assert_same(compiled(function, single, numbers), TWO[function](dtype(single), numbers))


@PRECISIONS
@pytest.mark.parametrize("function", COMPARISONS, ids=name)
def test_comparisons_are_as_in_numpy(function: Function, dtype: Any) -> None:
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
        store(out, 0, x)
        store(out, width(out), splat(a[1], x))
        store(out, 2 * width(out), splat(0.1, x))

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
def test_lanes_fill_two_registers(dtype: Any) -> None:
    @njit(error_model="numpy")
    def run(a: Any) -> Any:
        return width(a), width(load(a, 0)), unit_roundoff(load(a, 0)), unit_roundoff(a[0])

    numbers = edges(dtype)
    roundoff = {np.float64: 2.0**-53, np.float32: 2.0**-24}[dtype]
    expected = 128 // numbers.itemsize, 128 // numbers.itemsize, roundoff, roundoff
    assert run(numbers) == run.py_func(numbers) == expected
    assert dtype(1) + dtype(roundoff) == 1 < dtype(1) + dtype(1.01 * roundoff)


def test_loaded_lanes_do_not_change_with_the_array() -> None:
    values = np.arange(16.0)
    loaded = load(values, 0)
    values[:] = 0
    assert loaded.tolist() == list(range(16))
