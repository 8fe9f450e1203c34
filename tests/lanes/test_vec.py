"""Operators of Vec on single numbers, on lanes and on a mix of them, interpreted and compiled."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numba import njit

import minirt.lanes.compiled  # noqa: F401
from minirt.lanes import Vec, dot, load, width
from tests.lanes.numbers import PRECISIONS, assert_same, edges
from tests.lanes.test_operators import store


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
def on_single_numbers(a: Any) -> Any:
    u, v = Vec(a[0], a[1], a[2]), Vec(a[3], a[4], a[5])
    r, s = (u + v - v / a[6]), -u
    return r.x, r.y, r.z, s.x, s.y, s.z


@PRECISIONS
def test_compiled_vecs_may_be_of_single_numbers(dtype: Any) -> None:
    a = table(dtype, 1)
    u, v = a[:3], a[3:6]
    assert_same(np.array(on_single_numbers(a), dtype), [*(u + v - v * (1 / a[6])), *-u])


@PRECISIONS
def test_interpreted_operators_are_those_of_the_components(dtype: Any) -> None:
    n = 128 // np.dtype(dtype).itemsize
    a, b = table(dtype, 1), table(dtype, 2)
    columns, w = a.reshape(3, n), b[:3, None]
    u, v, s = Vec(*columns), Vec(*b[:3]), a[4 : 4 + n]
    for actual, right in (
        (u + v, columns + w),
        (u - v, columns - w),
        (v - u, w - columns),
        (s * v, s * w),
        (v * s, s * w),
        (u / s, columns * (1 / s)),
        (dtype(2) * u, 2 * columns),
        (-u, -columns),
    ):
        assert isinstance(actual, Vec)
        assert_same([actual.x, actual.y, actual.z], right)
        assert actual.x.dtype == dtype


@njit(error_model="numpy")
def products(a: Any, b: Any, out: Any) -> None:
    n = width(a)
    u, v = Vec(load(a, 0), load(a, n), load(a, 2 * n)), Vec(load(b, 0), load(b, n), load(b, 2 * n))
    w = Vec(b[0], b[n], b[2 * n])
    store(out[0], 0, dot(u, v))
    store(out[1], 0, dot(u, w))
    store(out[2], 0, dot(w, u))


@PRECISIONS
def test_the_dot_product_is_the_sum_of_products(dtype: Any) -> None:
    n = 128 // np.dtype(dtype).itemsize
    a, b = table(dtype, 1), table(dtype, 2)
    u, v = a.reshape(3, n), b.reshape(3, n)
    w = v[:, :1]
    right = [np.sum(u * v, axis=0), np.sum(u * w, axis=0), np.sum(u * w, axis=0)]
    size = [np.sum(np.abs(u * each), axis=0) for each in (v, w, w)]
    out = np.empty((3, n), dtype)
    products(a, b, out)
    assert (np.abs(out - right) <= 2 * np.finfo(dtype).eps * np.array(size)).all()  # a * b + c may round once
    assert_same(dot(Vec(*u), Vec(*v)), u[0] * v[0] + u[1] * v[1] + u[2] * v[2])


def test_a_vec_shows_its_numbers() -> None:
    assert repr(Vec(1.0, -2, 0.5)) == "Vec(1.0, -2, 0.5)"
