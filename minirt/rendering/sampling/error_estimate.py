"""How good a picture is that was refined, by how far it is from the one before."""

from __future__ import annotations

from math import sqrt

import numpy as np

from minirt.rendering.sampling.allocation import ERROR_EXPONENT

ROUNDING = 1 / 12  # mean square of what rounding to whole levels changes


def estimated_error(before: np.ndarray, after: np.ndarray, fewer: int, samples: int) -> float:
    """The error, as in `minirt.rendering.sampling.outcome` but with that of rounding, of a picture with so many `samples`.

    Both are uint8 (h, w, 4), equally opaque. Their differences have the squared errors of both, which are to each other
    as the numbers of samples are to the power of -1.5.
    """
    far = np.maximum(before, after) - np.minimum(before, after)
    square = float(np.square(far, dtype=np.uint16).sum(dtype=np.int64)) / (far.size * 3 / 4)
    ratio = (samples / fewer) ** ERROR_EXPONENT
    return sqrt(square / (1 + ratio) + ROUNDING) / 255
