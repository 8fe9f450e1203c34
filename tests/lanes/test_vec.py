"""Vec, reductions and square roots on single numbers, on lanes and on a mix of them, interpreted and compiled."""

from __future__ import annotations

import sys
from typing import Any

import gmpy2
import numpy as np
import pytest
from numba import njit

from minirt.kernel.machine_code.compile_process import environment
from minirt.kernel.machine_code.fingerprint import V3
from minirt.lanes import Vec, greatest, inverse_root, load, width
from minirt.lanes.compiled.operations import SERIES
from tests.lanes.test_operators import DTYPES, PRECISIONS, assert_same, edges, store
from tests.processes import run


def table(dtype: Any, seed: int) -> Any:
    """Return the x of a vector for each lane, then the y, then the z: random numbers, or edge cases for seed 0."""
    count = 3 * 128 // np.dtype(dtype).itemsize
    numbers = np.resize(edges(dtype), count) if seed == 0 else np.random.default_rng(seed).normal(size=count)
    return numbers.astype(dtype)


@njit(error_model="numpy")
def operators(a: Any, b: Any, out: Any) -> None:
    n = width(a)
    u, v = Vec(load(a, 0), load(a, n), load(a, 2 * n)), Vec(load(b, 0), load(b, n), load(b, 2 * n))
    w = Vec(b[0], b[n], b[2 * n])
    s = load(a, 4)
    results = (u + v, u - v, u * s, s * u, u / s, -u, u + w, w - u, u * b[1], b[1] * u, u / b[1], w * s, s * w, 2 * u)
    for k, r in enumerate(results):
        store(out[k], 0, r.x)
        store(out[k], n, r.y)
        store(out[k], 2 * n, r.z)


def expected(a: Any, b: Any) -> list[Any]:
    """Compute the results of `operators` by numpy, component by component."""
    n = a.size // 3
    u, v, w = a.reshape(3, n), b.reshape(3, n), b.reshape(3, n)[:, :1]
    s, t = a[4 : 4 + n], b[1]
    # A quotient is a product with the inverse.
    return [u + v, u - v, u * s, s * u, u * (1 / s), -u, u + w, w - u, u * t, t * u, u * (1 / t), w * s, s * w, 2 * u]


@PRECISIONS
@pytest.mark.parametrize(("one", "other"), [(1, 2), (0, 2), (1, 0), (0, 0)])
def test_compiled_operators_are_those_of_the_components(one: int, other: int, dtype: Any) -> None:
    a, b = table(dtype, one), table(dtype, other)[:: -1 if one == other else 1].copy()
    out = np.empty((14, a.size), dtype)
    operators(a, b, out)
    with np.errstate(all="ignore"):
        for actual, right in zip(out.reshape(14, 3, -1), expected(a, b), strict=True):
            assert_same(actual, right)


@njit(error_model="numpy")
def greatest_of(values: Any) -> float:
    return greatest(load(values, 0))


@PRECISIONS
@pytest.mark.parametrize("interpreted", [False, True])
def test_the_greatest_number_is_found_in_any_lane(interpreted: bool, dtype: Any) -> None:
    count = 128 // np.dtype(dtype).itemsize
    function = greatest_of.py_func if interpreted else greatest_of
    for index in range(count):
        for each in edges(dtype):
            values = np.full(count, each, dtype)
            values[index] = 2.5
            expected = 2.5 if np.isnan(each) else max(2.5, float(each))
            assert function(values) == expected
    assert function(np.arange(count, dtype=dtype)) == count - 1
    assert function(-np.arange(count, dtype=dtype)) == 0
    assert function(np.full(count, np.nan, dtype)) == -np.inf


LLVM_NAMES = {np.float64: "double", np.float32: "float"}


@njit(error_model="numpy")
def inverse_roots(a: Any, out: Any) -> None:
    for i in range(0, a.size, width(a)):
        store(out, i, inverse_root(load(a, i)))


def largest_error(dtype: Any) -> float:
    """Return the largest error of `inverse_root`, in units in the last place, over many exponents."""
    kind = np.finfo(dtype)
    random = np.random.default_rng(3)
    exponents = random.uniform(kind.minexp * 0.9, kind.maxexp * 0.9, 32_000)
    numbers = np.concatenate([2.0**exponents, random.uniform(0.9, 4.1, 32_000), 4.0 ** np.arange(-32, 32)])
    numbers = numbers.astype(dtype)
    out = np.empty_like(numbers)
    inverse_roots(numbers, out)
    exact = 1 / np.sqrt(numbers.astype(np.longdouble))
    return float(np.max(np.abs(out - exact) / np.spacing(exact.astype(dtype))))


@PRECISIONS
def test_the_error_is_within_two_units_in_the_last_place(dtype: Any) -> None:
    assert largest_error(dtype) <= 2


def refined(x: Any, estimate: Any, bits: int, series: tuple[float, ...]) -> Any:
    """Refine an estimate of 1 / sqrt(x) as `minirt.lanes.compiled.operations` does, each step rounded to `bits`."""

    def rounded(value: Any) -> Any:
        return gmpy2.mpfr(value, bits)

    with gmpy2.context(precision=500):  # exact: a fused product and sum are rounded once
        y = rounded(estimate)
        error = rounded(1 - x * rounded(y * y))
        first, *rest = series
        total = gmpy2.mpfr(first)
        for coefficient in rest:
            total = rounded(total * error + coefficient)
        return rounded(rounded(y * error) * total + y)


@PRECISIONS
@pytest.mark.parametrize(("error", "passes"), [(2.0**-14, True), (2.0**-7, False)])
def test_the_series_is_precise_for_any_estimate_within_the_promise(dtype: Any, error: float, passes: bool) -> None:
    """Processors differ in their estimates, which are only promised to be within 2^-14. A worse estimate fails."""
    kind = np.finfo(dtype)
    random = np.random.default_rng(6)
    errors = []
    for x in random.uniform(1, 4, 500).astype(dtype):
        with gmpy2.context(precision=500):
            exact = 1 / gmpy2.sqrt(gmpy2.mpfr(float(x)))
            for share in (-1, 1, random.uniform(-1, 1)):
                root = refined(
                    gmpy2.mpfr(float(x)), exact * (1 + share * error), kind.nmant + 1, SERIES[LLVM_NAMES[dtype]]
                )
                errors.append(abs(float((root - exact) / float(np.spacing(dtype(float(exact)))))))
    assert (max(errors) <= 2) == passes


def test_the_error_is_smaller_without_avx_512() -> None:
    program = "from tests.lanes.test_vec import DTYPES, largest_error; print(max(map(largest_error, DTYPES)))"
    ended = run([sys.executable, "-c", program], env=environment(V3), text=True)
    assert ended.returncode == 0, ended.stderr
    assert float(ended.stdout) <= 1.5  # a root and a division, each rounded
    assert len(DTYPES) == 2
