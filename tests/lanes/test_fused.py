"""Sums of products: the code that is emitted, not the compiler, says which product is not rounded."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
from numba import njit

import minirt.lanes.compiled  # noqa: F401
from minirt.kernel.compiler.pipeline import FLAGS
from minirt.lanes import Vec, dot, lane, load, width
from tests.shapes.regimes import Array

A, B, C, D = np.random.default_rng(3).uniform(0.5, 2, (4, 64))


def compiled(function: Any) -> Array:
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
    return not np.array_equal(compiled(lambda a, b, c, d: a * b + c), A * B + C)


def fused(a: Array, b: Array, c: Array) -> Array:
    """Return a b + c, rounded once where the processor can."""
    if not has_fma():
        result: Array = a * b + c
        return result
    exact = [Fraction(x) * Fraction(y) + Fraction(z) for x, y, z in zip(a, b, c, strict=True)]
    return np.array([float(each) for each in exact])


def test_the_first_product_of_a_sum_is_not_rounded() -> None:
    assert np.array_equal(compiled(lambda a, b, c, d: a * b + c * d), fused(A, B, C * D))
    assert np.array_equal(compiled(lambda a, b, c, d: c * d + a * b), fused(C, D, A * B))
    assert np.array_equal(fused(A, B, C * D), fused(C, D, A * B)) is not has_fma()


def test_the_first_product_of_a_difference_is_not_rounded() -> None:
    assert np.array_equal(compiled(lambda a, b, c, d: a * b - c * d), fused(A, B, -(C * D)))
    assert np.array_equal(compiled(lambda a, b, c, d: c - a * b), fused(-A, B, C))


def test_a_dot_product_rounds_one_product() -> None:
    expected = fused(D, D, fused(A, B, C * C))
    assert np.array_equal(compiled(lambda a, b, c, d: dot(Vec(a, c, d), Vec(b, c, d))), expected)


def test_the_product_of_a_vec_is_not_rounded() -> None:
    result = compiled(lambda a, b, c, d: (Vec(a, c, d) + b * Vec(c, d, a)).x)
    assert np.array_equal(result, fused(B, C, A))
