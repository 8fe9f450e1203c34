"""Estimates the error of a refined picture from its difference to the picture with fewer samples."""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt

import numpy as np

from minirt.rendering.developing.develop import rounding_error
from minirt.rendering.developing.tone import PLAIN, tone_named
from minirt.rendering.sampling.allocation import ERROR_EXPONENT

ROUNDING = 1 / 12  # mean squared error of rounding to whole levels
STRIP = 64  # lines processed at once: their data fits a processor's cache, which takes two thirds of the time


def estimated_error(
    before: np.ndarray,
    after: np.ndarray,
    fewer: int,
    samples: int,
    is_wanted: Callable[[], bool] = lambda: True,
    tone: str = PLAIN,
) -> float | None:
    """The RMSE of a picture `after` with `samples`, given the picture `before` with `fewer`.

    It is the error of `minirt.rendering.sampling.outcome` and that of rounding. Both are uint8 (h, w, 4), equally
    opaque. Their squared difference is the sum of both squared errors, whose ratio is that of the numbers of
    samples to the power of -1.5. With another tone than plain the error is that of the light of the levels, clamped to
    [0, 1]. None as soon as `is_wanted` says no, which is asked a few times a millisecond.
    """
    total, light = 0.0, np.minimum(tone_named(tone).light, 1.0)
    for top in range(0, len(before), STRIP):
        if not is_wanted():
            return None
        a, b = before[top : top + STRIP], after[top : top + STRIP]
        if tone == PLAIN:
            difference = np.maximum(a, b) - np.minimum(a, b)
            total += int(np.square(difference, dtype=np.uint16).sum(dtype=np.int64))
        else:
            total += float(np.square(light.take(a[..., :3]) - light.take(b[..., :3])).sum()) * 255**2
    ratio = (samples / fewer) ** ERROR_EXPONENT
    rounding = ROUNDING if tone == PLAIN else (255 * rounding_error(after, tone, dither=False)) ** 2
    return sqrt(total / (before.size * 3 / 4) / (1 + ratio) + rounding) / 255
