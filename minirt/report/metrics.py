"""Error metrics of pictures: RMSE, PSNR, changed pixels, FLIP; confidence intervals; error images.

Pictures are float64 (h, w, 3): radiance clamped to [0, 1], as a screen shows it.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, inf, log10, nan, pi, radians, sqrt

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from minirt.rendering.image import Image
from minirt.rendering.tone_mapping import decode_srgb

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
    """Return the percentile interval of the median of some values; NaN for fewer than three."""
    if len(values) < 3:
        return nan, nan
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


# Error images: the error of each pixel as a heat map; and where errors are largest.

CROP = 60, 80  # rows and columns of a crop, at most
LEAST = 1e-4  # errors up to this are black; an error of 1, black against white, is white
HEAT = np.array([[0, 0, 0], [40, 20, 120], [190, 30, 80], [250, 150, 20], [255, 255, 255]])  # one colour a decade


def error_image(picture: Picture, reference: Picture) -> Image:
    """Map the largest error of the three channels of each pixel to a colour, on a logarithmic scale."""
    error = np.abs(picture - reference).max(axis=-1)
    heat = np.log10(np.maximum(error, LEAST) / LEAST)
    return Image(np.stack([np.interp(heat, range(len(HEAT)), part) for part in HEAT.T], axis=-1).astype(np.uint8))


def worst_region(squares: np.ndarray) -> tuple[slice, slice]:
    """Return the rows and the columns of the crop of a picture with the largest sum of squared errors (h, w)."""
    height, width = np.minimum(CROP, squares.shape).tolist()
    total = np.pad(squares.cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))  # of all above and to the left
    across = total[:, width:] - total[:, :-width]
    sums = across[height:] - across[:-height]
    top, left = (int(each) for each in np.unravel_index(sums.argmax(), sums.shape))
    return slice(top, top + height), slice(left, left + width)


# FLIP: perceived difference of two pictures that alternate on a screen, in [0, 1] for each pixel, for pictures of low
# dynamic range (Andersson et al., FLIP: A Difference Evaluator for Alternating Images, 2020). Colours are blurred by
# the contrast sensitivity of the eye and compared in L*a*b*; differences of edges and points amplify them.
# Pictures are (h, w, 3) sRGB in [0, 1].

PER_DEGREE = 0.7 * (3840 / 0.7) * radians(1.0)  # pixels per degree: a screen of 3840 pixels and 0.7 m, seen from 0.7 m
# Contrast sensitivity of the eye as sums of Gaussians: (a, b) of each, for luminance, red against green and blue
# against yellow.
SENSITIVITY = (((1.0, 0.0047),), ((1.0, 0.0053),), ((34.1, 0.04), (13.5, 0.025)))
BLUR = ceil(3 * sqrt(0.04 / (2 * pi * pi)) * PER_DEGREE)  # radius of the widest Gaussian in pixels
FEATURE = 0.5 * 0.082 * PER_DEGREE  # pixels: half of the width of an edge that the eye can resolve
COLOUR_POWER, FEATURE_POWER = 0.7, 0.5
KNEE, KNEE_ERROR = 0.4, 0.95  # this share of the largest colour difference maps to this error

PRIMARIES = np.array([[0.64, 0.30, 0.15], [0.33, 0.60, 0.06], [0.03, 0.10, 0.79]])  # of sRGB: x, y and z
WHITE = np.array([0.3127, 0.3290, 0.3583]) / 0.3290  # D65
TO_XYZ = PRIMARIES * np.linalg.solve(PRIMARIES, WHITE) / WHITE[:, None]  # white is 1, 1, 1
FROM_XYZ = np.linalg.inv(TO_XYZ)


def flip(a: Picture, b: Picture) -> Picture:
    """Return the FLIP error of each pixel, (h, w), of two pictures as they are `perceived`."""
    far = difference(a, b) ** COLOUR_POWER
    # Small differences of colours, which are in [0, MOST], take most of the range of errors.
    colour = np.interp(far, (0.0, KNEE * MOST, MOST), (0.0, KNEE_ERROR, 1.0))
    feature = np.abs(a - b)[..., 3:].max(axis=-1) / sqrt(2)
    return colour ** (1 - feature**FEATURE_POWER)


def perceived(picture: Picture) -> Picture:
    """Filter a picture as the eye does: L*a*b* colours, and the strength of edges and of points, (h, w, 5)."""
    xyz = decode_srgb(picture) @ TO_XYZ.T
    x = np.arange(-ceil(3 * FEATURE), ceil(3 * FEATURE) + 1) / FEATURE
    bell = np.exp(-x * x / 2)
    slopes = balanced(-x * bell), balanced((x * x - 1) * bell)
    y, bell = xyz[..., 1], bell / bell.sum()
    strengths = (np.hypot(filtered(y, slope, bell), filtered(y, bell, slope)) for slope in slopes)  # across and down
    return np.dstack([colours(xyz), *strengths])


def colours(xyz: Picture) -> Picture:
    """Blur by contrast sensitivity and convert to L*a*b* with the Hunt effect: darker colours are less saturated."""
    x, y, z = np.moveaxis(xyz, -1, 0)
    y, red_green, blue_yellow = (blurred(*each) for each in zip((y, x - y, y - z), SENSITIVITY, strict=True))
    rgb = np.clip(np.stack([y + red_green, y, y - blue_yellow], axis=-1) @ FROM_XYZ.T, 0, 1)
    return lab(rgb @ TO_XYZ.T)


def lab(xyz: Picture) -> Picture:
    """Convert XYZ to L*a*b*, with a* and b* scaled by L* / 100 for the Hunt effect."""
    delta = 6 / 29
    x, y, z = np.moveaxis(np.where(xyz > delta**3, np.cbrt(xyz), xyz / (3 * delta**2) + 4 / 29), -1, 0)
    lightness = 116 * y - 16
    return np.stack([lightness, 5 * lightness * (x - y), 2 * lightness * (y - z)], axis=-1)


def blurred(channel: Picture, sums: tuple[tuple[float, float], ...]) -> Picture:
    """Filter a channel by a contrast sensitivity function."""
    squares = (np.arange(-BLUR, BLUR + 1) / PER_DEGREE) ** 2
    total, weight = np.zeros_like(channel), 0.0
    for a, b in sums:
        bell, height = np.exp(-pi * pi * squares / b), a * sqrt(pi / b)
        total += height * filtered(channel, bell, bell)
        weight += height * bell.sum() ** 2
    return total / weight


def balanced(weights: Picture) -> Picture:
    """Scale filter weights so that the positive ones sum to 1 and the negative ones to -1."""
    positive, negative = np.maximum(weights, 0.0), np.minimum(weights, 0.0)
    return positive / positive.sum() - negative / negative.sum()


def filtered(channel: Picture, across: Picture, down: Picture) -> Picture:
    """Apply a separable filter, across and then down; pixels beyond the border repeat the border."""
    for weights in (across, down):  # each turn filters along the last axis and swaps both
        wide = np.pad(channel, ((0, 0), (len(weights) // 2,) * 2), "edge")
        channel = (sliding_window_view(wide, len(weights), axis=1) @ weights).T
    return channel


def difference(a: Picture, b: Picture) -> Picture:
    """HyAB colour distance, for large differences (Abasi et al. 2020)."""
    return np.abs(a[..., 0] - b[..., 0]) + np.hypot(a[..., 1] - b[..., 1], a[..., 2] - b[..., 2])


GREEN, BLUE = (lab(np.array([[colour]]) @ TO_XYZ.T) for colour in ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
MOST = float(difference(GREEN, BLUE)[0, 0]) ** COLOUR_POWER  # the largest difference of two sRGB colours
