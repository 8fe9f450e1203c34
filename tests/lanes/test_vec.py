"""Vec: its operators on single numbers, on lanes and on a mix of them, interpreted and compiled."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numba import njit

import minirt.lanes.compiled  # noqa: F401
from minirt.lanes import Vec, dot, load
from tests.lanes.numbers import NUMBERS, assert_same
from tests.lanes.test_operators import put

U = 2.0**-53
RANDOM = np.random.default_rng(1)
A, B = RANDOM.normal(size=(2, 24))
EDGES = NUMBERS[:24]


@njit(error_model="numpy")
def operators(a: Any, b: Any, out: Any) -> None:
    u, v = Vec(load(a, 0), load(a, 8), load(a, 16)), Vec(load(b, 0), load(b, 8), load(b, 16))
    w = Vec(b[0], b[8], b[16])
    s = load(a, 4)
    results = (u + v, u - v, u * s, s * u, u / s, -u, u + w, w - u, u * b[1], b[1] * u, u / b[1], w * s, s * w, 2 * u)
    for k, r in enumerate(results):
        put(out[k], 0, r.x)
        put(out[k], 8, r.y)
        put(out[k], 16, r.z)


def expected(a: Any, b: Any) -> list[Any]:
    """The same by numpy, component by component."""
    u, v, w = a.reshape(3, 8), b.reshape(3, 8), b.reshape(3, 8)[:, :1]
    s, t = a[4:12], b[1]
    # A quotient is a product with the inverse.
    return [u + v, u - v, u * s, s * u, u * (1 / s), -u, u + w, w - u, u * t, t * u, u * (1 / t), w * s, s * w, 2 * u]


@pytest.mark.parametrize(("a", "b"), [(A, B), (EDGES, B), (A, EDGES), (EDGES, EDGES[::-1].copy())])
def test_operators_compiled(a: Any, b: Any) -> None:
    out = np.empty((14, 24))
    operators(a, b, out)
    with np.errstate(all="ignore"):
        for actual, right in zip(out.reshape(14, 3, 8), expected(a, b), strict=True):
            assert_same(actual, right)


@njit(error_model="numpy")
def of_single_numbers(a: Any) -> Any:
    u, v = Vec(a[0], a[1], a[2]), Vec(a[3], a[4], a[5])
    r, s = (u + v * 2 - v / a[6]), -u
    return r.x, r.y, r.z, s.x, s.y, s.z


def test_single_numbers_compiled() -> None:
    u, v = A[:3], A[3:6]
    with np.errstate(all="ignore"):
        right = [*(u + v * 2 - v * (1 / A[6])), *-u]
    assert_same(of_single_numbers(A), right)


def test_operators_interpreted() -> None:
    u, v, s = Vec(A[:8], A[8:16], A[16:]), Vec(*B[:3]), A[4:12]
    w = B[:3, None]
    columns = A.reshape(3, 8)
    for made, right in (
        (u + v, columns + w),
        (u - v, columns - w),
        (v - u, w - columns),
        (s * v, s * w),
        (v * s, s * w),
        (u / s, columns * (1 / s)),
        (np.float64(2) * u, 2 * columns),
        (-u, -columns),
    ):
        assert isinstance(made, Vec)
        assert_same([made.x, made.y, made.z], right)


@njit(error_model="numpy")
def products(a: Any, b: Any, out: Any) -> None:
    u, v = Vec(load(a, 0), load(a, 8), load(a, 16)), Vec(load(b, 0), load(b, 8), load(b, 16))
    put(out, 0, dot(u, v))
    put(out, 8, dot(u, Vec(b[0], b[8], b[16])))
    put(out, 16, dot(Vec(b[0], b[8], b[16]), u))


def test_the_scalar_product() -> None:
    u, v = A.reshape(3, 8), B.reshape(3, 8)
    right = [np.sum(u * v, axis=0), np.sum(u * v[:, :1], axis=0), np.sum(u * v[:, :1], axis=0)]
    size = [np.sum(np.abs(u * w), axis=0) for w in (v, v[:, :1], v[:, :1])]
    out = np.empty(24)
    products(A, B, out)
    assert (np.abs(out.reshape(3, 8) - right) <= 4 * U * np.array(size)).all()  # a * b + c may round once
    assert_same(dot(Vec(*u), Vec(*v)), u[0] * v[0] + u[1] * v[1] + u[2] * v[2])


def test_a_vec_shows_its_numbers() -> None:
    assert repr(Vec(1.0, -2, 0.5)) == "Vec(1.0, -2, 0.5)"
