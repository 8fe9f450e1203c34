"""How far a picture is from another. Pictures are float64 (h, w, 3) as shown: light, clamped to [0, 1]."""

from __future__ import annotations

from math import inf, log10

import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.float64]


def shown(light: Picture) -> Picture:
    """What a screen shows of light."""
    return np.clip(light, 0.0, 1.0)


def rmse(a: Picture, b: Picture) -> float:
    """The root of the mean square error, 1 from black to white."""
    return float(np.sqrt(np.mean((a - b) ** 2)))


def psnr(error: float) -> float:
    """The peak signal-to-noise ratio of a root mean square error, in decibels."""
    return -20.0 * log10(error) if error > 0 else inf


def levels(picture: Picture) -> NDArray[np.uint8]:
    """The picture in 8 bits a colour, rounded as the kernel does."""
    return (picture * 255.0 + 0.5).astype(np.uint8)


def changed(a: Picture, b: Picture) -> int:
    """The number of pixels that differ in 8 bits."""
    return int(np.any(levels(a) != levels(b), axis=-1).sum())
