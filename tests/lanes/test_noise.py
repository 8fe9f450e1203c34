"""Gradient noise on numbers and on lanes: against tables of whole numbers and differences of 50 digits."""

from __future__ import annotations

from itertools import product
from typing import Any

import mpmath
import numpy as np
import pytest
from numba import njit

import minirt.kernel.compiler.object_code  # noqa: F401  (registers what is compiled)
from minirt.kernel.compiler.pipeline import FLAGS
from minirt.lanes import Vec, load, save, width
from minirt.lanes import mathematics as noise_module
from minirt.lanes.mathematics import GREATEST, PERIOD, corner_gradient, noise_and_gradient, remainder
from tests.lanes.numbers import PRECISIONS
from tests.reference import texturing as reference

RANDOM = np.random.default_rng(1)
POINTS = RANDOM.uniform(-300, 300, (3, 4096))
CELLS = np.array(list(product((-150, -149, -1, 0, 1, 74, 75, 148), repeat=3)), float).T  # corners of cells


@njit(**FLAGS)
def on_lanes(p: Any, out: Any) -> None:
    for i in range(0, p.shape[1], width(p)):
        value, gradient = noise_and_gradient(Vec(load(p[0], i), load(p[1], i), load(p[2], i)))
        save(value, out[0], i)
        save(gradient.x, out[1], i)
        save(gradient.y, out[2], i)
        save(gradient.z, out[3], i)


def compiled(p: np.ndarray) -> np.ndarray:
    """Return the noise at points (3, n) and its gradient, (4, n)."""
    out = np.empty((4, p.shape[1]), p.dtype)
    on_lanes(p, out)
    return out


def interpreted(p: np.ndarray) -> np.ndarray:
    """Return the same by the plain formula."""
    value, gradient = noise_and_gradient(Vec(*p))
    return np.stack([value, gradient.x, gradient.y, gradient.z])


BOTH = pytest.mark.parametrize("noise_of", [interpreted, compiled])


def largest_difference(noise_of: Any, p: np.ndarray) -> float:
    """Return the largest difference from the noise with tables."""
    return float(np.abs(noise_of(p)[0] - reference.noise(*p.astype(np.float64))).max())


@BOTH
@PRECISIONS
def test_noise_is_that_of_tables_of_whole_numbers(noise_of: Any, dtype: Any) -> None:
    p = POINTS.astype(dtype)
    assert noise_of(p).dtype == dtype
    assert largest_difference(noise_of, p) < 40 * np.finfo(dtype).eps


WRONG: dict[str, tuple[str, Any]] = {
    "another hash": ("scrambled", lambda s: remainder(s * s)),
    "another period": ("PERIOD", 151.0),
    "gradients negated": ("corner_gradient", lambda h: -corner_gradient(h)),
    "linear blend": ("ease", lambda t: t),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_noise_is_noticed(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(noise_module, *WRONG[name])
    assert largest_difference(interpreted, POINTS) > 0.1


@BOTH
@PRECISIONS
def test_noise_is_0_at_corners_where_it_has_their_gradients(noise_of: Any, dtype: Any) -> None:
    value, *gradient = noise_of(CELLS.astype(dtype))
    assert not value.any()
    assert (np.sort(np.abs(gradient), axis=0) == [[0], [1], [1]]).all()  # one of twelve


@BOTH
def test_noise_repeats_after_its_period(noise_of: Any) -> None:
    p = np.floor(POINTS) + 0.375  # so that sums are exact
    for shift in PERIOD * np.eye(3):
        assert np.array_equal(noise_of(p + shift[:, None]), noise_of(p))
        assert not np.array_equal(noise_of(p + shift[:, None] / PERIOD), noise_of(p))


def test_gradients_are_evenly_distributed() -> None:
    g = corner_gradient(np.arange(-74.0, 75.0))
    _, counts = np.unique(np.stack([g.x, g.y, g.z]), axis=1, return_counts=True)
    assert sorted(counts) == [12] * 7 + [13] * 5


def bound_at(p: np.ndarray) -> np.ndarray:
    """Return the greatest noise possible at points of the first cell, whatever the gradients of its corners."""
    total = np.zeros(p.shape[1:])
    for corner in product((0, 1), repeat=3):
        away = np.abs(p - np.reshape(corner, (3, *[1] * (p.ndim - 1))))
        steepest = np.sort(away, axis=0)[1:].sum(axis=0)  # two components of 1 or -1
        near = 1 - away
        total += np.prod(near**3 * (near * (near * 6 - 15) + 10), axis=0) * steepest
    return total


def test_noise_keeps_its_bound() -> None:
    side = np.linspace(0, 1, 81)
    coarse = bound_at(np.array(np.meshgrid(side, side, side)))
    best = np.array(np.unravel_index(coarse.argmax(), coarse.shape))[[1, 0, 2]] / 80
    fine = np.linspace(-0.02, 0.02, 81)
    assert 0 <= GREATEST - bound_at(best[:, None, None, None] + np.array(np.meshgrid(fine, fine, fine))).max() < 1e-5
    assert 0.9 < np.abs(interpreted(RANDOM.uniform(0, PERIOD, (3, 200_000)))[0]).max() < GREATEST


@BOTH
def test_noise_is_smooth_across_cells(noise_of: Any) -> None:
    inside = np.floor(POINTS) + RANDOM.random(POINTS.shape)
    for axis in range(3):
        before, behind = inside.copy(), inside.copy()
        behind[axis] = np.floor(behind[axis])
        before[axis] = behind[axis] - 1e-9
        assert np.abs(noise_of(before) - noise_of(behind)).max() < 1e-7  # also the gradient


def test_the_gradient_is_that_of_differences_of_50_digits() -> None:
    points = POINTS[:, :64]
    with mpmath.workdps(50):
        exact = np.vectorize(mpmath.mpf, otypes=[object])(points)
        step = mpmath.mpf(10) ** -20
        for axis in range(3):
            ends = [exact.copy(), exact.copy()]
            ends[0][axis], ends[1][axis] = exact[axis] - step, exact[axis] + step
            before, behind = (reference.noise(*end) for end in ends)
            slope = ((behind - before) / (2 * step)).astype(float)
            for noise_of in (interpreted, compiled):
                assert np.abs(noise_of(points)[1 + axis] - slope).max() < 1e-12
