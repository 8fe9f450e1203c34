"""Inverse square root: within two units in the last place, with the estimate of AVX-512 and without."""

from __future__ import annotations

import sys
from typing import Any

import gmpy2
import numpy as np
import pytest
from numba import njit

import minirt.lanes.compiled  # noqa: F401
from minirt.kernel.machine_code.compile_process import environment
from minirt.kernel.machine_code.fingerprint import V3
from minirt.lanes import Vec, inverse_root, lane, load, unit, width
from minirt.lanes.compiled.operations import SERIES
from tests.lanes.numbers import DTYPES, PRECISIONS
from tests.lanes.test_operators import store
from tests.processes import run

LLVM_NAMES = {np.float64: "double", np.float32: "float"}


@njit(error_model="numpy")
def inverse_roots(a: Any, out: Any) -> None:
    for i in range(0, a.size, width(a)):
        store(out, i, inverse_root(load(a, i)))


@njit(error_model="numpy")
def units(a: Any, out: Any) -> None:
    n = width(a)
    v = unit(Vec(load(a, 0), load(a, n), load(a, 2 * n)))
    for ray in range(n):
        out[0, ray], out[1, ray], out[2, ray] = lane(v.x, ray), lane(v.y, ray), lane(v.z, ray)


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


@PRECISIONS
def test_a_power_of_four_changes_the_exponent_alone(dtype: Any) -> None:
    numbers = np.random.default_rng(4).uniform(1, 4, 32).astype(dtype)
    one, other = np.empty((2, 32), dtype)
    inverse_roots(numbers, one)
    inverse_roots(numbers * dtype(4.0**20), other)
    assert np.array_equal(other, one * dtype(2.0**-20))


@PRECISIONS
def test_unit_vectors_are_precise(dtype: Any) -> None:
    n = 128 // np.dtype(dtype).itemsize
    v = np.random.default_rng(5).normal(size=(3, n)).astype(dtype)
    out = np.empty_like(v)
    units(v.ravel(), out)
    exact = v.astype(np.longdouble) / np.sqrt((v.astype(np.longdouble) ** 2).sum(axis=0))
    assert np.abs(out - exact).max() <= 4 * np.finfo(dtype).eps
    interpreted = unit(Vec(*v))
    assert np.abs([interpreted.x, interpreted.y, interpreted.z] - exact).max() <= 4 * np.finfo(dtype).eps
    assert interpreted.x.dtype == dtype


def test_the_error_is_smaller_without_avx_512() -> None:
    program = "from tests.lanes.test_roots import DTYPES, largest_error; print(max(map(largest_error, DTYPES)))"
    ended = run([sys.executable, "-c", program], env=environment(V3), text=True)
    assert ended.returncode == 0, ended.stderr
    assert float(ended.stdout) <= 1.5  # a root and a division, each rounded
    assert len(DTYPES) == 2
