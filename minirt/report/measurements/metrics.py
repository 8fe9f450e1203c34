"""Error metrics of pictures: RMSE, PSNR, changed pixels.

Pictures are float64 (h, w, 3): radiance clamped to [0, 1], as a screen shows it.
"""

from __future__ import annotations

from math import inf, log10

import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.float64]


def clamped(light: Picture) -> Picture:
    """Clamp radiance to what a screen shows."""
    return np.clip(light, 0.0, 1.0)


def rmse(a: Picture, b: Picture) -> float:
    """Root mean square error over all pixels and channels; 1 from black to white."""
    return float(np.sqrt(np.mean((a - b) ** 2)))


def psnr(error: float) -> float:
    """Peak signal-to-noise ratio of an RMSE, in decibels."""
    return -20.0 * log10(error) if error > 0 else inf


def to_8_bits(picture: Picture) -> NDArray[np.uint8]:
    """Round a picture to 8 bits per channel, as the kernel does."""
    return (picture * 255.0 + 0.5).astype(np.uint8)


def changed(a: Picture, b: Picture) -> int:
    """Count the pixels that differ in 8 bits."""
    return int(np.any(to_8_bits(a) != to_8_bits(b), axis=-1).sum())
