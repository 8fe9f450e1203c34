"""FLIP: perceived difference of two pictures that alternate on a screen, in [0, 1] for each pixel.

Andersson et al., FLIP: A Difference Evaluator for Alternating Images, 2020, for pictures of low dynamic range. Colours
are blurred by the contrast sensitivity of the eye and compared in L*a*b*; differences of edges and points amplify the
colour difference. Pictures are (h, w, 3) sRGB in [0, 1].
"""

from __future__ import annotations

from math import ceil, pi, radians, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

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


class Perceived(NamedTuple):
    """A picture as the eye perceives it."""

    colours: Array  # (h, w, 3)
    edges: Array  # (h, w) strength of edges
    points: Array  # (h, w) strength of points


def flip(a: Perceived, b: Perceived) -> Array:
    """Return the FLIP error of each pixel, (h, w)."""
    colour = colour_error(difference(a.colours, b.colours) ** COLOUR_POWER)
    feature = np.maximum(np.abs(a.edges - b.edges), np.abs(a.points - b.points)) / sqrt(2)
    error: Array = colour ** (1 - feature**FEATURE_POWER)
    return error


def perceived(picture: Array) -> Perceived:
    """Filter a picture as the eye does."""
    xyz = linear(picture) @ TO_XYZ.T
    x = np.arange(-ceil(3 * FEATURE), ceil(3 * FEATURE) + 1) / FEATURE
    bell = np.exp(-x * x / 2)
    return Perceived(
        colours(xyz),
        gradient_strength(xyz[..., 1], bell, balanced(-x * bell)),
        gradient_strength(xyz[..., 1], bell, balanced((x * x - 1) * bell)),
    )


def linear(srgb: Array) -> Array:
    """Decode sRGB to linear light."""
    low: Array = srgb / 12.92
    return np.where(srgb <= 0.04045, low, ((srgb + 0.055) / 1.055) ** 2.4)


def colours(xyz: Array) -> Array:
    """Blur by contrast sensitivity and convert to L*a*b* with the Hunt effect: darker colours are less saturated."""
    x, y, z = np.moveaxis(xyz, -1, 0)
    y, red_green, blue_yellow = (
        blurred(channel, sums) for channel, sums in zip((y, x - y, y - z), SENSITIVITY, strict=True)
    )
    rgb = np.clip(np.stack([y + red_green, y, y - blue_yellow], axis=-1) @ FROM_XYZ.T, 0, 1)
    return lab(rgb @ TO_XYZ.T)


def lab(xyz: Array) -> Array:
    """Convert XYZ to L*a*b*, with a* and b* scaled by L* / 100 for the Hunt effect."""
    delta = 6 / 29
    x, y, z = np.moveaxis(np.where(xyz > delta**3, np.cbrt(xyz), xyz / (3 * delta**2) + 4 / 29), -1, 0)
    lightness = 116 * y - 16
    return np.stack([lightness, 5 * lightness * (x - y), 2 * lightness * (y - z)], axis=-1)


def blurred(channel: Array, sums: tuple[tuple[float, float], ...]) -> Array:
    """Filter a channel by a contrast sensitivity function."""
    squares = (np.arange(-BLUR, BLUR + 1) / PER_DEGREE) ** 2
    total, weight = np.zeros_like(channel), 0.0
    for a, b in sums:
        bell, height = np.exp(-pi * pi * squares / b), a * sqrt(pi / b)
        total += height * filtered(channel, bell, bell)
        weight += height * bell.sum() ** 2
    return total / weight


def gradient_strength(channel: Array, bell: Array, slope: Array) -> Array:
    """Return the magnitude of a channel's response to a filter across and the same filter down."""
    bell = bell / bell.sum()
    return np.hypot(filtered(channel, slope, bell), filtered(channel, bell, slope))


def balanced(weights: Array) -> Array:
    """Scale filter weights so that the positive ones sum to 1 and the negative ones to -1."""
    positive, negative = np.maximum(weights, 0.0), np.minimum(weights, 0.0)
    scaled: Array = positive / positive.sum() - negative / negative.sum()
    return scaled


def filtered(channel: Array, across: Array, down: Array) -> Array:
    """Apply a separable filter, across and then down; pixels beyond the border repeat the border."""
    for weights in (across, down):  # each turn filters along the last axis and swaps both
        wide, total = np.pad(channel, ((0, 0), (len(weights) // 2,) * 2), "edge"), np.zeros_like(channel)
        for start, weight in enumerate(weights):
            total += weight * wide[:, start : start + channel.shape[1]]
        channel = total.T
    return channel


def difference(a: Array, b: Array) -> Array:
    """HyAB colour distance, for large differences (Abasi et al. 2020)."""
    far: Array = np.abs(a[..., 0] - b[..., 0]) + np.hypot(a[..., 1] - b[..., 1], a[..., 2] - b[..., 2])
    return far


GREEN, BLUE = (lab(np.array([[colour]]) @ TO_XYZ.T) for colour in ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
MOST = float(difference(GREEN, BLUE)[0, 0]) ** COLOUR_POWER  # the largest difference of two sRGB colours


def colour_error(far: Array) -> Array:
    """Map colour differences in [0, MOST] to errors in [0, 1]; small differences take most of the range."""
    return np.interp(far, (0.0, KNEE * MOST, MOST), (0.0, KNEE_ERROR, 1.0))
