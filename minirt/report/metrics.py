"""Error metrics of pictures: RMSE, PSNR, changed pixels, FLIP; confidence intervals; error images.

Pictures are float64 (h, w, 3): radiance clamped to [0, 1], as a screen shows it.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, log10, nan, radians, sqrt

import numpy as np
from numpy.typing import NDArray

from minirt.rendering.image import Image

Picture = NDArray[np.float64]


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


def quantiles(a: Picture, b: Picture) -> list[float]:
    """Return the median, the 95 % quantile and the largest of the errors of pixels: RMS of the channels of each."""
    errors = np.sqrt(np.mean((a - b) ** 2, axis=-1))
    return np.quantile(errors, (0.5, 0.95, 1.0), method="inverted_cdf").tolist()


PER_DEGREE = 0.7 * (3840 / 0.7) * radians(1.0)  # pixels per degree: a screen of 3840 pixels and 0.7 m, seen from 0.7 m


def flip(a: Picture, b: Picture) -> float:
    """Return the mean FLIP error of two pictures, in sRGB, by the program of its authors; NaN where that is missing.

    FLIP is the perceived difference of two pictures that alternate on a screen, in [0, 1] (Andersson et al., FLIP: A
    Difference Evaluator for Alternating Images, 2020).
    """
    try:
        import flip_evaluator
    except ImportError:
        return nan
    pictures = (each.astype(np.float32) for each in (a, b))
    how = {"inputsRGB": True, "applyMagma": False, "parameters": {"ppd": PER_DEGREE}}
    return float(flip_evaluator.evaluate(*pictures, "LDR", **how)[1])


# 95 % confidence intervals: bootstrap of times and of errors (Efron and Tibshirani, An Introduction to the Bootstrap,
# 1993), and Student's t for fitted lines.

ENDS = 0.025, 0.975  # quantiles at the ends of an interval
RESAMPLES = 1000
SEED = 20240608
LEAST_POINTS = 3  # of a line
BLOCK = 16  # pixels along an edge of a block: errors of neighbouring pixels are not independent, those of blocks nearly
# The 97.5 % quantile of Student's t, by degrees of freedom from 1 on.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228)

Interval = tuple[float, float]  # its ends; NaN where there is too little data for one


def of_median(values: Sequence[float]) -> Interval:
    """Return the percentile interval of the median of some values; the least and the largest of fewer than three."""
    if len(values) < 3:
        return min(values), max(values)
    random, numbers = np.random.default_rng(SEED), np.array(values)
    medians = np.median(numbers[random.integers(0, len(numbers), (RESAMPLES, len(numbers)))], axis=1)
    low, high = np.quantile(medians, ENDS).tolist()
    return low, high


def of_rmse(picture: Picture, right: Picture, doubt: float) -> Interval:
    """Return the percentile interval of the RMSE between two pictures, from resampled blocks of pixels.

    It tells how far the error of another picture of the same nature would lie. `doubt` is the RMSE of the picture
    `right` itself: the interval also holds the error against a perfect reference.
    """
    squares, pixels = block_sums(((picture - right) ** 2).mean(axis=-1))
    random = np.random.default_rng(SEED)
    often = random.poisson(1.0, (RESAMPLES, len(pixels)))  # how often each block is drawn
    often[often.sum(axis=1) == 0] = 1
    low, high = np.quantile((often @ squares) / (often @ pixels), ENDS).tolist()
    return max(0.0, low - doubt * doubt) ** 0.5, high**0.5


def block_sums(squares: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the sum of each block of a picture (h, w), and the number of its pixels; blocks at an end are smaller."""
    starts = [np.arange(0, size, BLOCK) for size in squares.shape]
    sums = np.add.reduceat(np.add.reduceat(squares, starts[0], axis=0), starts[1], axis=1)
    heights, widths = (np.diff([*start, size]) for start, size in zip(starts, squares.shape, strict=True))
    return sums.ravel(), np.outer(heights, widths).ravel()


def fit(x: np.ndarray, y: np.ndarray) -> tuple[float, float, float, float]:
    """Fit a straight line by least squares to the points with finite x, of which at least three must differ.

    Return its slope, the ends of the confidence interval of that, and its value at 0; NaN without enough points.
    """
    x, y = x[np.isfinite(x)], y[np.isfinite(x)]
    if len(np.unique(x)) < LEAST_POINTS:
        return nan, nan, nan, nan
    (slope, constant), covariance = np.polyfit(x, y, 1, cov=True)
    reach = STUDENT[min(len(x) - 2, len(STUDENT)) - 1] * sqrt(covariance[0, 0])
    return float(slope), float(slope - reach), float(slope + reach), float(constant)


# Error images: the error of each pixel as a heat map.

LEAST = 1e-4  # errors up to this are black; an error of 1, black against white, is white
HEAT = np.array([[0, 0, 0], [40, 20, 120], [190, 30, 80], [250, 150, 20], [255, 255, 255]])  # one colour a decade


def error_image(picture: Picture, reference: Picture) -> Image:
    """Map the largest error of the three channels of each pixel to a colour, on a logarithmic scale."""
    error = np.abs(picture - reference).max(axis=-1)
    heat = np.log10(np.maximum(error, LEAST) / LEAST)
    return Image(np.stack([np.interp(heat, range(len(HEAT)), part) for part in HEAT.T], axis=-1).astype(np.uint8))
