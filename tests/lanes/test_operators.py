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
from minirt.lanes import WIDTH, lane, load, splat, where
from tests.lanes.numbers import FIRST, NUMBERS, SECOND, assert_same

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
    for ray in range(WIDTH):
        out[start + ray] = lane(x, ray)


def compiled(function: Function, *given: Any) -> Any:
    """The function, compiled, on all lanes of arrays and on single numbers."""
    jitable = function if function in (*ARITHMETIC, *COMPARISONS, operator.neg) else register_jitable(function)
    verdict = function in COMPARISONS

    if len(given) == 1:

        def run(a: Any, out: Any) -> None:
            for i in range(0, out.size, WIDTH):
                put(out, i, jitable(load(a, i)))
    elif np.ndim(given[1]) == 0:

        def run(a: Any, b: Any, out: Any) -> None:
            for i in range(0, out.size, WIDTH):
                x = jitable(load(a, i), b)
                put(out, i, where(x, 1.0, 0.0) if verdict else x)
    elif np.ndim(given[0]) == 0:

        def run(a: Any, b: Any, out: Any) -> None:
            for i in range(0, out.size, WIDTH):
                x = jitable(a, load(b, i))
                put(out, i, where(x, 1.0, 0.0) if verdict else x)
    else:

        def run(a: Any, b: Any, out: Any) -> None:
            for i in range(0, out.size, WIDTH):
                x = jitable(load(a, i), load(b, i))
                put(out, i, where(x, 1.0, 0.0) if verdict else x)

    out = np.empty(max(np.size(each) for each in given))
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


@pytest.mark.parametrize("function", ONE, ids=name)
def test_of_one_number(function: Function) -> None:
    expected = ONE[function](NUMBERS)
    assert_same(compiled(function, NUMBERS), expected)
    assert_same(function(NUMBERS), expected)
    if function is not operator.neg:
        assert_same(on_numbers(function, NUMBERS), expected)


@pytest.mark.parametrize("function", TWO, ids=name)
def test_of_two_numbers(function: Function) -> None:
    expected = TWO[function](FIRST, SECOND)
    assert_same(compiled(function, FIRST, SECOND), expected)
    assert_same(function(FIRST, SECOND), expected)
    if function not in ARITHMETIC:
        assert_same(on_numbers(function, FIRST, SECOND), expected)


@pytest.mark.parametrize("function", TWO, ids=name)
def test_of_lanes_and_a_single_number(function: Function) -> None:
    for single in (3, 0.1):
        assert_same(compiled(function, NUMBERS, single), TWO[function](NUMBERS, np.float64(single)))
        assert_same(compiled(function, single, NUMBERS), TWO[function](np.float64(single), NUMBERS))


@pytest.mark.parametrize("function", COMPARISONS, ids=name)
def test_comparisons(function: Function) -> None:
    assert_same(compiled(function, FIRST, SECOND), function(FIRST, SECOND).astype(float))
    assert_same(compiled(function, NUMBERS, 1.5), function(NUMBERS, 1.5).astype(float))
    assert_same(compiled(function, 1, NUMBERS), function(1.0, NUMBERS).astype(float))


def test_splat_and_load_at_any_index() -> None:
    @njit(error_model="numpy")
    def run(a: Any, start: int, out: Any) -> None:
        put(out, 0, load(a, start))
        put(out, WIDTH, splat(a[1]))
        put(out, 2 * WIDTH, splat(7))

    for start in range(4):
        out = np.empty(3 * WIDTH)
        run(NUMBERS, start, out)
        expected = [*NUMBERS[start : start + WIDTH], *[NUMBERS[1]] * WIDTH, *[7.0] * WIDTH]
        assert_same(out, expected)
        assert_same([*load(NUMBERS, start), *splat(NUMBERS[1]), *splat(7)], expected)


def test_what_is_loaded_does_not_change_with_the_array() -> None:
    values = np.arange(8.0)
    loaded = load(values, 0)
    values[:] = 0
    assert loaded.tolist() == [0, 1, 2, 3, 4, 5, 6, 7]
