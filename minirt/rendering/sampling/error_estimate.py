"""Estimates the error of a refined picture from its difference to the picture with fewer samples."""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt

import numpy as np

from minirt.rendering.sampling.allocation import ERROR_EXPONENT

ROUNDING = 1 / 12  # mean squared error of rounding to whole levels
STRIP = 64  # lines processed at once: their data fits a processor's cache, which takes two thirds of the time


def estimated_error(
    before: np.ndarray, after: np.ndarray, fewer: int, samples: int, is_wanted: Callable[[], bool] = lambda: True
) -> float | None:
    """The RMSE of a picture `after` with `samples`, given the picture `before` with `fewer`.

    It is the error of `minirt.rendering.sampling.outcome` and that of rounding. Both are uint8 (h, w, 4), equally
    opaque. Their squared difference is the sum of both squared errors, whose ratio is that of the numbers of
    samples to the power of -1.5. None as soon as `is_wanted` says no, which is asked a few times a millisecond.
    """
    total = 0
    for top in range(0, len(before), STRIP):
        if not is_wanted():
            return None
        a, b = before[top : top + STRIP], after[top : top + STRIP]
        difference = np.maximum(a, b) - np.minimum(a, b)
        total += int(np.square(difference, dtype=np.uint16).sum(dtype=np.int64))
    ratio = (samples / fewer) ** ERROR_EXPONENT
    return sqrt(total / (before.size * 3 / 4) / (1 + ratio) + ROUNDING) / 255
