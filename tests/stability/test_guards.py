"""The guards that formulas and renderer rely on hold as they are compiled: fastmath would break them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from minirt.kernel.compiler.pipeline import FLAGS


def guards(D: float, t: float) -> tuple[bool, bool, bool, float]:
    """NaN is no hit, infinity is no nearer hit, and light that is NaN or infinite ends in [0, 1]."""
    light = t if t > 0.0 else 0.0
    return D >= 0.0, not (D >= 0.0), t < np.inf, light if light < 1.0 else 1.0


def guarded(flags: dict[str, Any]) -> bool:
    """Whether the guards hold when they are compiled with these flags."""
    compiled = njit(**flags)(guards)
    cases = [(np.nan, np.inf), (np.nan, np.nan), (np.inf, np.inf), (-1.0, -np.inf), (0.0, 0.5)]
    return all(compiled(*case) == guards(*case) for case in cases)


def test_guards_hold_with_the_flags_of_the_kernel_and_not_with_fastmath() -> None:
    assert guarded(FLAGS)
    assert not guarded({**FLAGS, "fastmath": True})
