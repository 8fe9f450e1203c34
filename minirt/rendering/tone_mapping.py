"""Tone mapping: the levels of 8 bits for the light of pixels, by a tone curve and with or without dithering.

- plain: levels are in proportion to light.
- srgb: the transfer function of sRGB (IEC 61966-2-1).
- filmic: Narkowicz's fit to the tone curve of ACES (Narkowicz, ACES Filmic Tone Mapping Curve, 2015), applied to red,
  green and blue each, then the transfer function of sRGB. Light up to 7.24 keeps differences.

With srgb and filmic the colours and pictures of a scene are decoded by the transfer function of sRGB before they become
shares of light; with plain they are shares of light as they are.

Dithering replaces rounding. A channel whose light lies between those of two levels takes the upper one where its share
of the way between them is above a threshold of blue noise. So the mean light of an even area stays as it is.

The kernel itself rounds light in proportion to levels; other tones and dithering come after it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from io import BytesIO
from math import nan, sqrt
from typing import NamedTuple

import numpy as np

from minirt.helpers import package
from minirt.rendering.outcome import ROUNDING
from minirt.rendering.packing.camera import Crop, Request
from minirt.rendering.threads import Run
from minirt.scene import Scene

LEVELS = 256
PLAIN, SRGB, FILMIC = "plain", "srgb", "filmic"
TOE, SLOPE, OFFSET, GAMMA = 0.04045, 12.92, 0.055, 2.4  # IEC 61966-2-1
A, B, C, D, E = 2.51, 0.03, 2.43, 0.59, 0.14  # Narkowicz: (A x^2 + B x) / (C x^2 + D x + E)


class Tone(NamedTuple):
    """A tone curve by its values at the n levels of a picture."""

    light: np.ndarray  # (n,) the light that each level stands for
    halfway: np.ndarray  # (n - 1,) the light from which on a level and not the one below it is nearer, on the curve
    decodes: bool  # whether colours are decoded by the transfer function of sRGB


@cache
def tone_named(name: str, levels: int = LEVELS) -> Tone:
    """Return the tone curve with a name, for so many levels; KeyError for an unknown one."""
    numbers, highest = np.arange(levels), levels - 1
    return Tone(light_of(numbers / highest, name), light_of((numbers[1:] - 0.5) / highest, name), name != PLAIN)


def light_of(levels: np.ndarray, name: str) -> np.ndarray:
    """Return the light that levels in [0, 1] stand for on a tone curve."""
    shown = decode_srgb(levels)
    a, b, c = A - C * shown, B - D * shown, -E * shown
    return {PLAIN: levels, SRGB: shown, FILMIC: (np.sqrt(b * b - 4 * a * c) - b) / (2 * a)}[name]


def decode_srgb(levels: np.ndarray) -> np.ndarray:
    return np.where(levels <= TOE, levels / SLOPE, ((levels + OFFSET) / (1 + OFFSET)) ** GAMMA)


NOISE = 64  # pixels along an edge of the square of blue noise


@cache
def blue_noise() -> np.ndarray:
    """Return thresholds for dithering, (NOISE, NOISE), evenly spaced in (0, 1): a square without low frequencies, that
    repeats without a seam.

    The file has their ranks, made by Ulichney's void-and-cluster method (The void-and-cluster method for dither array
    generation, 1993).
    """
    ranks: np.ndarray = np.load(BytesIO(package.read(__name__, "blue_noise.npy")))
    return (ranks + 0.5) / (NOISE * NOISE)


NO_LINEAR = np.zeros((0, 0, 3))
DITHERING = sqrt(2)  # ratio of the RMSE of dithering to that of rounding, where all fractions of a level are as likely
STRIP = 4096  # pixels of the lines at once, about: arrays so small that malloc keeps their pages
FRACTION = 15  # lowest bits of a float32 that `levels_below` leaves out
CLIPPED = 1 + 2.0**-20  # light above this share of that of the highest level is clipped, and not only rounded


def map_tones(
    light: np.ndarray,
    pixels: np.ndarray,
    tone: str,
    dither: bool = False,
    crop: Crop | None = None,
    run: Run = lambda job: job(),
    is_wanted: Callable[[], bool] = lambda: True,
) -> None:
    """Write the levels of light, float64 (h, w, 3), into pixels, uint8 (h, w, 4) in the order blue, green, red, alpha.

    Pixels whose light is NaN stay as they are. The pattern that dithers begins with the whole picture, of which `crop`
    may be a part. `run` runs a job on all threads, which end early where `is_wanted`, which is asked every few
    milliseconds, says no.
    """
    curve, lines = tone_named(tone), max(1, STRIP // light.shape[1])
    strips = iter(range(0, len(light), lines))
    left, above = (crop.left, crop.top) if crop else (0, 0)

    def map_strips() -> None:
        for top in strips:
            if not is_wanted():
                return
            strip = np.ascontiguousarray(light[top : top + lines])
            levels = dithered(strip, curve, left, above + top) if dither else rounded(strip, tone)
            into, known = pixels[top : top + lines], ~np.isnan(strip[..., 0])
            if known.all():
                into[..., 2::-1], into[..., 3] = levels, 255
            else:
                into[known] = np.insert(levels[known][:, ::-1], 3, 255, axis=-1)

    run(map_strips)


def rounded(light: np.ndarray, tone: str) -> np.ndarray:
    """Return the nearest levels of 8 bits. The upper bits of light tell them up to one."""
    with np.errstate(over="ignore"):
        level = levels_below(tone).take(light.astype(np.float32).view(np.int32) >> FRACTION, mode="wrap")
    return level + (light >= np.append(tone_named(tone).halfway, nan).take(level))


@cache
def levels_below(tone: str) -> np.ndarray:
    """Return the least level of light for the sign, exponent and 8 bits of the fraction that it has in float32."""
    bits = tone_named(tone).halfway.astype(np.float32).view(np.int32) >> FRACTION  # no two of these are the same
    return np.searchsorted(bits, np.arange(1 << 16)).astype(np.uint8)


def dithered(light: np.ndarray, curve: Tone, left: int, above: int) -> np.ndarray:
    """Return dithered levels of light (h, w, 3), which begins at this column and row of the picture."""
    exact = np.interp(light, curve.light, np.arange(LEVELS))
    with np.errstate(invalid="ignore"):  # NaN, whose level is not used
        levels = exact.astype(np.uint8)
    height, width, _ = light.shape
    rows, columns = np.arange(above, above + height) % NOISE, np.arange(left, left + width) % NOISE
    return levels + (exact - levels > blue_noise()[np.ix_(rows, columns)][..., None])


def clipped_pixels(light: np.ndarray, tone: str) -> int:
    """Count the pixels of which a channel is brighter than the highest level."""
    return int((light > CLIPPED * tone_named(tone).light[-1]).any(axis=-1).sum())


def rounding_error(pixels: np.ndarray, tone: str, dither: bool) -> float:
    """Return the RMSE, in light clamped to [0, 1], of a picture's levels against the light that they stand for.

    Light is taken to be anywhere between a level's neighbours: between `halfway` to both where it was rounded, and
    with a chance that falls with the distance where it was dithered.
    """
    curve = tone_named(tone)
    if dither:
        widths = np.diff(np.minimum(curve.light, 1.0), prepend=0.0, append=1.0) ** 2
        variances = (widths[1:] + widths[:-1]) / 12
    else:
        variances = np.diff(np.minimum(curve.halfway, 1.0), prepend=0.0, append=1.0) ** 2 / 12
    counts = np.zeros(LEVELS, np.int64)
    lines = max(1, STRIP // pixels.shape[1])
    for top in range(0, len(pixels), lines):  # as counting keeps the interpreter from all other threads
        counts += np.bincount(pixels[top : top + lines, ..., :3].ravel(), minlength=LEVELS)
    return sqrt(float(counts @ variances) / max(counts.sum(), 1))


class ToneMapper:
    """Maps the tones of the pictures of one renderer, and keeps the light of a picture until then."""

    def __init__(self, run: Run, dither: bool) -> None:
        self.run = run
        self.dither = dither
        self.scratch = NO_LINEAR  # the light of the last picture for which nobody else kept it

    def needed(self, scene: Scene) -> bool:
        """Whether the levels of a scene's pictures are others than the kernel's: rounded, in proportion to light."""
        return scene.camera.tone != PLAIN or self.dither

    def light_for(self, request: Request, edges_only: bool = False) -> np.ndarray:
        """Return the array for the light of a picture: that of the request, else `scratch` where levels are made of it,
        else one without rows.

        With `edges_only` `scratch` is filled with NaN, which stays for pixels that are not drawn.
        """
        if request.linear is not None or not self.needed(request.scene):
            self.scratch = NO_LINEAR
            return NO_LINEAR if request.linear is None else request.linear
        shape = (*request.pixels.shape[:2], 3)
        if self.scratch.shape != shape:
            self.scratch = np.empty(shape)
        if edges_only:
            self.scratch[...] = nan
        return self.scratch

    def apply(self, request: Request, is_wanted: Callable[[], bool] = lambda: True) -> None:
        """Write the levels of a picture, if the kernel has not; as `map_tones` only while it is wanted."""
        scene, pixels, light, crop = request
        if self.needed(scene):
            map_tones(light, pixels, scene.camera.tone, self.dither, crop, self.run, is_wanted)

    def rounding(self, request: Request) -> float:
        """Return the RMSE of rounding or dithering a picture, in light clamped to [0, 1]."""
        if request.scene.camera.tone == PLAIN:
            return DITHERING * ROUNDING if self.dither else ROUNDING
        return rounding_error(request.pixels, request.scene.camera.tone, self.dither)

    def floor(self, request: Request, draw: Callable[[], object]) -> float:
        """Return the error below which rounding decides: it makes up nine tenths of the RMSE of a picture, and more.
        `draw` draws a first picture, which tells it for a curve."""
        if request.scene.camera.tone != PLAIN:
            draw()
        return self.rounding(request) / 2
