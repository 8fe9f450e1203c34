"""Estimates the error of a refined picture from its difference to the picture with fewer samples."""

from __future__ import annotations

from math import sqrt

import numpy as np

from minirt.rendering.sampling.allocation import ERROR_EXPONENT

ROUNDING = 1 / 12  # mean squared error of rounding to whole levels


def estimated_error(before: np.ndarray, after: np.ndarray, fewer: int, samples: int) -> float:
    """The RMSE of a picture `after` with `samples`, given the picture `before` with `fewer`.

    It is the error of `minirt.rendering.sampling.outcome` and that of rounding. Both are uint8 (h, w, 4), equally
    opaque. Their squared difference is the sum of both squared errors, whose ratio is that of the numbers of
    samples to the power of -1.5.
    """
    difference = np.maximum(before, after) - np.minimum(before, after)
    squared = float(np.square(difference, dtype=np.uint16).sum(dtype=np.int64)) / (difference.size * 3 / 4)
    ratio = (samples / fewer) ** ERROR_EXPONENT
    return sqrt(squared / (1 + ratio) + ROUNDING) / 255
