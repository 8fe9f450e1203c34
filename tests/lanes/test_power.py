"""Powers, on numbers and on lanes: against 60 digits."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest
from numba import njit

import minirt.kernel.compiler.object_code  # noqa: F401  (registers what is compiled)
from minirt.kernel.compiler.pipeline import FLAGS
from minirt.lanes import exponent, load, save, two_to
from minirt.lanes.mathematics import power as power_of

BASES = np.concatenate([np.linspace(0.0, 1.0, 97), 1.0 - 0.5 ** np.arange(1, 54), 0.5 ** np.arange(1, 60, 0.37)])
EXPONENTS = (1.0, 1.5, 2.0, 7.0, 50.0, 1e3, 1e6)


@njit(**FLAGS)
def on_lanes(x: Any, n: Any, out: Any) -> None:
    save(power_of(load(x, 0), n), out, 0)


def compiled(bases: np.ndarray, n: float) -> np.ndarray:
    out = np.empty_like(bases)
    for start in range(0, len(bases), 16):
        packet = np.resize(bases[start : start + 16], 128 // bases.itemsize)
        powers = np.empty_like(packet)
        on_lanes(packet, bases.dtype.type(n), powers)
        out[start : start + 16] = powers[: len(bases[start : start + 16])]
    return out


@pytest.mark.parametrize("n", EXPONENTS)
def test_powers_of_float64_keep_the_promised_error(n: float) -> None:
    with mpmath.workdps(60):
        exact = [mpmath.mpf(x) ** mpmath.mpf(n) for x in BASES]
        for powers in (power_of(BASES, n), compiled(BASES, n)):
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
    for powers in (power_of(bases, np.float32(n)), compiled(bases, n)):
        assert powers.dtype == np.float32
        logarithms = np.abs(np.log(np.maximum(bases, 1e-30).astype(np.float64)))
        assert (np.abs(powers - exact) <= exact * (1e-6 + 2e-7 * n * logarithms) + 1e-37).all()


def test_exponents_and_powers_of_two_are_exact() -> None:
    x = np.array([0.0, 5e-324, 2.0**-1022, 0.75, 1.0, 1.999, 2.0, 3e300])
    assert exponent(x).tolist() == [-1023, -1023, -1022, -1, 0, 0, 1, 998]
    assert two_to(np.array([-1100.0, -1023.0, -1022.0, -1.0, 0.0, 9.0])).tolist() == [0, 0, 2.0**-1022, 0.5, 1, 512]
