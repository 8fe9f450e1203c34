"""Numbers with which arithmetic goes wrong first, and how results are compared."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np

from minirt.lanes import WIDTH

TINY = sys.float_info.min
EDGES = [0.0, 5e-324, 1e-310, TINY, 1e-160, 0.1, 0.5, 1.0, 1.5, 2.5, 3.0, 1e15 + 0.5, 1e154, 1e300, sys.float_info.max]
NUMBERS = np.array([sign * each for each in [*EDGES, np.inf, np.nan] for sign in (1, -1)] + [7.0, -7.25] * 3)
assert NUMBERS.size % WIDTH == 0
FIRST, SECOND = (side.ravel() for side in np.meshgrid(NUMBERS, NUMBERS, indexing="ij"))  # every number with every other


def assert_same(actual: Any, expected: Any) -> None:
    """Equal bit for bit, -0 and 0 apart; a NaN is any NaN."""
    actual, expected = np.broadcast_arrays(np.asarray(actual, float), np.asarray(expected, float))
    nan = np.isnan(expected)
    assert np.array_equal(np.isnan(actual), nan)
    assert np.array_equal(actual[~nan].view(np.int64), expected[~nan].view(np.int64))
