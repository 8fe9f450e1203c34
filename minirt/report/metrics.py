"""Error metrics of pictures: RMSE, PSNR, changed pixels.

Pictures are float64 (h, w, 3): radiance clamped to [0, 1], as a screen shows it.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, log10, nan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.image import Image

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


# 95 % confidence intervals: bootstrap of times and of errors (Efron and Tibshirani, An Introduction to the Bootstrap,
# 1993), and Student's t for fitted lines.


LEVEL = 0.95
RESAMPLES = 1000
SEED = 20240608
BLOCK = 16  # pixels along an edge of a block: errors of neighbouring pixels are not independent, those of blocks nearly
# The 97.5 % quantile of Student's t, by degrees of freedom from 1 on.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228)


class Interval(NamedTuple):
    """A confidence interval; NaN where there is too little data for one."""

    low: float
    high: float


UNKNOWN = Interval(nan, nan)


def of_median(values: Sequence[float]) -> Interval:
    """Return the percentile interval of the median of some values; NaN for fewer than three."""
    if len(values) < 3:
        return UNKNOWN
    random, numbers = np.random.default_rng(SEED), np.array(values)
    medians = np.median(numbers[random.integers(0, len(numbers), (RESAMPLES, len(numbers)))], axis=1)
    return percentiles(medians)


def of_rmse(picture: Picture, right: Picture, doubt: float) -> Interval:
    """Return the percentile interval of the RMSE between two pictures, from resampled blocks of pixels.

    It tells how far the error of another picture of the same nature would lie. `doubt` is the RMSE of the picture
    `right` itself: the interval also holds the error against a perfect reference.
    """
    squares, pixels = block_sums(((picture - right) ** 2).mean(axis=-1))
    random = np.random.default_rng(SEED)
    often = random.poisson(1.0, (RESAMPLES, len(pixels)))  # how often each block is drawn
    often[often.sum(axis=1) == 0] = 1
    low, high = percentiles((often @ squares) / (often @ pixels))
    return Interval(max(0.0, low - doubt * doubt) ** 0.5, high**0.5)


def block_sums(squares: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the sum of each block of a picture (h, w), and the number of its pixels; blocks at an end are smaller."""
    starts = [np.arange(0, size, BLOCK) for size in squares.shape]
    sums = np.add.reduceat(np.add.reduceat(squares, starts[0], axis=0), starts[1], axis=1)
    heights, widths = (np.diff([*start, size]) for start, size in zip(starts, squares.shape, strict=True))
    return sums.ravel(), np.outer(heights, widths).ravel()


def percentiles(values: np.ndarray) -> Interval:
    """Return the interval that holds `LEVEL` of some values, the same share left out at both ends."""
    low, high = np.quantile(values, [(1 - LEVEL) / 2, (1 + LEVEL) / 2]).tolist()
    return Interval(low, high)


class Line(NamedTuple):
    """A straight line fitted by least squares, and the confidence interval of its slope."""

    slope: float
    intercept: float
    interval: Interval


def fit(x: np.ndarray, y: np.ndarray) -> Line:
    """Fit a straight line to at least two points, of which two have different x; the interval needs three points."""
    dx, dy = x - x.mean(), y - y.mean()
    slope = float(dx @ dy / (dx @ dx))
    intercept, free = float(y.mean() - slope * x.mean()), len(x) - 2
    if not free:
        return Line(slope, intercept, UNKNOWN)
    deviation = float(np.sqrt(((dy - slope * dx) ** 2).sum() / free / (dx @ dx)))
    reach = STUDENT[min(free, len(STUDENT)) - 1] * deviation
    return Line(slope, intercept, Interval(slope - reach, slope + reach))


# Error images: the error of each pixel as a heat map.


LEAST = 1e-4  # errors up to this are black; an error of 1, black against white, is white
HEAT = np.array([[0, 0, 0], [40, 20, 120], [190, 30, 80], [250, 150, 20], [255, 255, 255]])  # one colour a decade


def error_image(picture: Picture, reference: Picture) -> Image:
    """Map the largest error of the three channels of each pixel to a colour, on a logarithmic scale."""
    error = np.abs(picture - reference).max(axis=-1)
    heat = np.log10(np.maximum(error, LEAST) / LEAST)
    return Image(np.stack([np.interp(heat, range(len(HEAT)), part) for part in HEAT.T], axis=-1).astype(np.uint8))
