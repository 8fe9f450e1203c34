"""Arctangents, powers and noise on numbers and on lanes: against 60 digits, and for noise against the reference."""

from __future__ import annotations

from itertools import product
from typing import Any

import mpmath
import numpy as np
import pytest

from minirt.lanes import Vec, exponent, load, two_to
from minirt.lanes import mathematics as noise_module
from minirt.lanes.mathematics import GREATEST, PERIOD, arctan2, corner_gradient, noise_and_gradient, remainder
from minirt.lanes.mathematics import power as power_of
from tests.lanes.test_operators import PRECISIONS, assert_same, pairs
from tests.reference import texturing as reference
from tests.shapes.execution_modes import on_lanes, vec_lanes

ULPS = 3.0  # what the documentation promises


def compiled(y: np.ndarray, x: np.ndarray) -> np.ndarray:
    return on_lanes(angle_lanes, 1, y, x)[0]


def angle_lanes(i: int, y: Any, x: Any) -> Any:
    return (arctan2(load(y, i), load(x, i)),)


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


BASES = np.concatenate([np.linspace(0.0, 1.0, 97), 1.0 - 0.5 ** np.arange(1, 54), 0.5 ** np.arange(1, 60, 0.37)])
EXPONENTS = (1.0, 1.5, 2.0, 7.0, 50.0, 1e3, 1e6)


def compiled_power(bases: np.ndarray, n: float) -> np.ndarray:
    padded = np.resize(bases, len(bases) + -len(bases) % 32)
    return on_lanes(power_lanes, 1, bases.dtype.type(n), padded)[0, : len(bases)]


def power_lanes(i: int, n: Any, x: Any) -> Any:
    return (power_of(load(x, i), n),)


@pytest.mark.parametrize("n", EXPONENTS)
def test_powers_of_float64_keep_the_promised_error(n: float) -> None:
    with mpmath.workdps(60):
        exact = [mpmath.mpf(x) ** mpmath.mpf(n) for x in BASES]
        for powers in (power_of(BASES, n), compiled_power(BASES, n)):
            for x, right, value in zip(BASES, exact, powers, strict=True):
                if right < 1e-307:
                    assert 0.0 <= value <= 1e-300
                else:
                    allowed = 1e-15 + 6e-16 * n * abs(float(mpmath.log(x)))
                    assert abs(mpmath.mpf(float(value)) / right - 1) <= allowed, (x, n)


@pytest.mark.parametrize("n", EXPONENTS)
def test_powers_of_float32_keep_their_error(n: float) -> None:
    bases = BASES.astype(np.float32)
    exact = bases.astype(np.float64) ** n
    for powers in (power_of(bases, np.float32(n)), compiled_power(bases, n)):
        assert powers.dtype == np.float32
        logarithms = np.abs(np.log(np.maximum(bases, 1e-30).astype(np.float64)))
        assert (np.abs(powers - exact) <= exact * (1e-6 + 2e-7 * n * logarithms) + 1e-37).all()


def test_exponents_and_powers_of_two_are_exact() -> None:
    x = np.array([0.0, 5e-324, 2.0**-1022, 0.75, 1.0, 1.999, 2.0, 3e300])
    assert exponent(x).tolist() == [-1023, -1023, -1022, -1, 0, 0, 1, 998]
    assert two_to(np.array([-1100.0, -1023.0, -1022.0, -1.0, 0.0, 9.0])).tolist() == [0, 0, 2.0**-1022, 0.5, 1, 512]


RANDOM = np.random.default_rng(1)
POINTS = RANDOM.uniform(-300, 300, (3, 4096))
CELLS = np.array(list(product((-150, -149, -1, 0, 1, 74, 75, 148), repeat=3)), float).T  # corners of cells


def noise_lanes(i: int, p: Any) -> Any:
    value, gradient = noise_and_gradient(vec_lanes(p, i))
    return value, gradient.x, gradient.y, gradient.z


def compiled_noise(p: np.ndarray) -> np.ndarray:
    """Return the noise at points (3, n) and its gradient, (4, n)."""
    return on_lanes(noise_lanes, 4, p)


def interpreted_noise(p: np.ndarray) -> np.ndarray:
    """Return the same by the plain formula."""
    value, gradient = noise_and_gradient(Vec(*p))
    return np.stack([value, gradient.x, gradient.y, gradient.z])


BOTH_NOISES = pytest.mark.parametrize("noise_of", [interpreted_noise, compiled_noise])


def largest_difference(noise_of: Any, p: np.ndarray) -> float:
    """Return the largest difference from the noise with tables."""
    return float(np.abs(noise_of(p)[0] - reference.noise(*p.astype(np.float64))).max())


@BOTH_NOISES
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
    assert largest_difference(interpreted_noise, POINTS) > 0.1


@BOTH_NOISES
@PRECISIONS
def test_noise_is_0_at_corners_where_it_has_their_gradients(noise_of: Any, dtype: Any) -> None:
    value, *gradient = noise_of(CELLS.astype(dtype))
    assert not value.any()
    assert (np.sort(np.abs(gradient), axis=0) == [[0], [1], [1]]).all()  # one of twelve


@BOTH_NOISES
def test_noise_repeats_after_its_period(noise_of: Any) -> None:
    p = np.floor(POINTS) + 0.375  # so that sums are exact
    for shift in PERIOD * np.eye(3):
        assert np.array_equal(noise_of(p + shift[:, None]), noise_of(p))
        assert not np.array_equal(noise_of(p + shift[:, None] / PERIOD), noise_of(p))


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
    assert 0.9 < np.abs(interpreted_noise(RANDOM.uniform(0, PERIOD, (3, 200_000)))[0]).max() < GREATEST


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
            for noise_of in (interpreted_noise, compiled_noise):
                assert np.abs(noise_of(points)[1 + axis] - slope).max() < 1e-12
