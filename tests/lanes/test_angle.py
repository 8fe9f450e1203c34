"""arctan2 on numbers and on lanes: against 60 digits, and against numpy for zeros, infinities and NaN."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest
from numba import njit

import minirt.kernel.compiler.object_code  # noqa: F401  (registers what is compiled)
from minirt.kernel.compiler.pipeline import FLAGS
from minirt.lanes import load, save, width
from minirt.lanes.mathematics import arctan2
from tests.lanes.numbers import PRECISIONS, assert_same, pairs

ULPS = 3.0  # what the documentation promises


@njit(**FLAGS)
def on_lanes(y: Any, x: Any, out: Any) -> None:
    for i in range(0, y.size, width(y)):
        save(arctan2(load(y, i), load(x, i)), out, i)


def compiled(y: np.ndarray, x: np.ndarray) -> np.ndarray:
    out = np.empty_like(y)
    on_lanes(y, x, out)
    return out


def interpreted(y: np.ndarray, x: np.ndarray) -> np.ndarray:
    with np.errstate(all="ignore"):
        return arctan2(y, x)


BOTH = pytest.mark.parametrize("angles_of", [interpreted, compiled])


def largest_error(angles: np.ndarray, y: np.ndarray, x: np.ndarray) -> float:
    """Return the largest error, in units in the last place of the exact angle."""
    with mpmath.workdps(60):
        right = [mpmath.atan2(mpmath.mpf(float(b)), mpmath.mpf(float(a))) for b, a in zip(y, x, strict=True)]
        spacings = np.spacing(np.abs(np.array([float(each) for each in right])).astype(angles.dtype))
        steps = zip(angles, right, spacings, strict=True)
        return max(float(abs(mpmath.mpf(float(a)) - r) / float(step)) for a, r, step in steps)


@BOTH
@PRECISIONS
def test_angles_all_around_are_within_three_units_in_the_last_place(angles_of: Any, dtype: Any) -> None:
    random = np.random.default_rng(1)
    turns = random.uniform(-np.pi, np.pi, 3200)
    near = np.arange(-8, 9)[:, None] * (np.pi / 8) + 0.1 * 0.5 ** np.arange(64)  # and near the axes and diagonals
    turns = np.concatenate([turns, near.ravel()])
    sizes = 2.0 ** random.uniform(-30, 30, turns.size)
    y, x = (sizes * np.sin(turns)).astype(dtype), (sizes * np.cos(turns)).astype(dtype)
    assert largest_error(angles_of(y, x), y, x) <= ULPS


@BOTH
@PRECISIONS
def test_ratios_at_which_the_formula_changes_are_as_precise(angles_of: Any, dtype: Any) -> None:
    eps = float(np.finfo(dtype).eps)
    ratios = [c * (1 + k * eps) for c in (0.25, 0.75, 1.0) for k in range(-16, 16)]
    y = np.array(ratios, dtype)
    x = np.ones_like(y)
    for a, b in ((y, x), (x, y), (-y, -x)):
        assert largest_error(angles_of(a, b), a, b) <= ULPS


@BOTH
@PRECISIONS
def test_zeros_infinities_and_nan_are_as_in_numpy(angles_of: Any, dtype: Any) -> None:
    y, x = pairs(dtype)
    result, right = angles_of(y, x), np.arctan2(y, x)
    assert result.dtype == dtype
    special = (y == 0) | (x == 0) | ~np.isfinite(y) | ~np.isfinite(x)
    assert special.sum() > 200
    assert_same(result[special], right[special])
    assert np.array_equal(np.signbit(result[~special]), np.signbit(right[~special]))
    tiny = float(np.finfo(dtype).smallest_subnormal)
    assert (np.abs(result - right)[~special] <= 4 * np.finfo(dtype).eps * np.abs(right)[~special] + 2 * tiny).all()


def test_a_single_number_is_as_precise() -> None:
    assert arctan2(np.float64(1.0), np.float64(-1.0)) == 0.75 * np.pi
    assert arctan2(np.float64(-0.0), np.float64(-3.0)) == -np.pi
