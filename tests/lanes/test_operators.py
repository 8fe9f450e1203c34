"""Operators on numbers, lanes and masks, interpreted and compiled, bit for bit, and which products are fused."""

from __future__ import annotations

import operator
from collections.abc import Callable
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import pytest
from numba import njit
from numba.extending import register_jitable

from minirt import lanes
from minirt.kernel.compiler.pipeline import FLAGS
from minirt.lanes import Vec, any, dot, first, lane, load, splat, unit_roundoff, where, width
from tests.shapes.regimes import Array

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


@register_jitable
def load_lanes(values: Any, i: int) -> Any:
    return load(values, i)


@register_jitable
def keep_number(number: float, i: int) -> float:
    return number


def compiled(function: Function, *arguments: Any) -> Any:
    """Call a function, compiled, on lanes of arrays and on single numbers."""
    jitable = function if function in (*ARITHMETIC, *COMPARISONS, operator.neg) else register_jitable(function)
    is_comparison = function in COMPARISONS

    if len(arguments) == 1:

        def run(a: Any, out: Any) -> None:
            for i in range(0, out.size, width(out)):
                store(out, i, jitable(load(a, i)))
    else:
        first, second = (load_lanes if np.ndim(each) else keep_number for each in arguments)

        def run(a: Any, b: Any, out: Any) -> None:
            for i in range(0, out.size, width(out)):
                x = jitable(first(a, i), second(b, i))
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
    assert_same(compiled(function, numbers, 3), TWO[function](numbers, dtype(3)))
    assert_same(compiled(function, 0.1, numbers), TWO[function](dtype(0.1), numbers))


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


A, B, C, D = np.random.default_rng(3).uniform(0.5, 2, (4, 64))


def compiled_sum(function: Any) -> Array:
    """Return the results of a function of four numbers on lanes, compiled as the kernel is."""
    inner = njit(**FLAGS)(function)

    def run(a: Any, b: Any, c: Any, d: Any, out: Any) -> None:
        for start in range(0, out.size, width(out)):
            result = inner(load(a, start), load(b, start), load(c, start), load(d, start))
            for i in range(width(out)):
                out[start + i] = lane(result, i)

    out = np.zeros(64)
    njit(**FLAGS)(run)(A, B, C, D, out)
    return out


@cache
def has_fma() -> bool:
    """Whether the processor that is compiled for rounds a b + c once; others round twice, as numpy does."""
    return not np.array_equal(compiled_sum(lambda a, b, c, d: a * b + c), A * B + C)


def fused(a: Array, b: Array, c: Array) -> Array:
    """Return a b + c, rounded once where the processor can."""
    if not has_fma():
        result: Array = a * b + c
        return result
    exact = [Fraction(x) * Fraction(y) + Fraction(z) for x, y, z in zip(a, b, c, strict=True)]
    return np.array([float(each) for each in exact])


def test_the_first_product_of_a_sum_is_not_rounded() -> None:
    assert np.array_equal(compiled_sum(lambda a, b, c, d: a * b + c * d), fused(A, B, C * D))
    assert np.array_equal(compiled_sum(lambda a, b, c, d: c * d + a * b), fused(C, D, A * B))
    assert np.array_equal(fused(A, B, C * D), fused(C, D, A * B)) is not has_fma()


def test_the_first_product_of_a_difference_is_not_rounded() -> None:
    assert np.array_equal(compiled_sum(lambda a, b, c, d: a * b - c * d), fused(A, B, -(C * D)))
    assert np.array_equal(compiled_sum(lambda a, b, c, d: c - a * b), fused(-A, B, C))


def test_a_dot_product_rounds_one_product() -> None:
    expected = fused(D, D, fused(A, B, C * C))
    assert np.array_equal(compiled_sum(lambda a, b, c, d: dot(Vec(a, c, d), Vec(b, c, d))), expected)


def test_the_product_of_a_vec_is_not_rounded() -> None:
    result = compiled_sum(lambda a, b, c, d: (Vec(a, c, d) + b * Vec(c, d, a)).x)
    assert np.array_equal(result, fused(B, C, A))
