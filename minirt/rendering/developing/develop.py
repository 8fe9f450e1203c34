"""Develops a picture: the levels of its pixels from their light.

Dithering replaces rounding. A channel whose light lies between those of two levels takes the upper one where its share
of the way between them is above a threshold of blue noise. So the mean light of an even area stays as it is.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from math import sqrt

import numpy as np

from minirt.rendering.developing.blue_noise import SIZE, blue_noise
from minirt.rendering.developing.steps import Steps
from minirt.rendering.developing.tone import LEVELS, PLAIN, tone_named

STRIP = 64  # lines at once: their data fits a processor's cache
CLIPPED = 1 + 2.0**-20  # light above this share of that of the highest level is clipped, and not only rounded

Job = Callable[[], object]


def needs_developing(tone: str, dither: bool) -> bool:
    """Whether the levels of a picture are others than those that the kernel writes: rounded, in proportion to light."""
    return tone != PLAIN or dither


def develop(
    light: np.ndarray,
    pixels: np.ndarray,
    tone: str,
    dither: bool = False,
    run: Callable[[list[Job]], object] | None = None,
    threads: int = 1,
    left: int = 0,
    top: int = 0,
) -> None:
    """Write the levels of light, float64 (h, w, 3), into pixels, uint8 (h, w, 4) in the order blue, green, red, alpha.

    Pixels whose light is NaN stay as they are. `run` runs jobs side by side. The first pixel is that at column `left`
    and row `top` of the pattern that dithers.
    """
    tops, pattern = range(0, len(light), STRIP), (shifted_pattern(left, top) if dither else None)
    jobs: list[Job] = [partial(develop_strips, light, pixels, tone, pattern, tops[i::threads]) for i in range(threads)]
    (run or run_in_turn)(jobs)


def run_in_turn(jobs: list[Job]) -> None:
    """Run jobs one after the other."""
    for job in jobs:
        job()


def shifted_pattern(left: int, top: int) -> np.ndarray:
    """Return the thresholds of dithering, shifted so that those at a column and a row come first."""
    return np.roll(blue_noise(), (-top, -left), axis=(0, 1))


def develop_strips(light: np.ndarray, pixels: np.ndarray, tone: str, pattern: np.ndarray | None, tops: range) -> None:
    """Develop the strips of a picture whose first lines are `tops`; thresholds, if given, dither."""
    for top in tops:
        strip = np.ascontiguousarray(light[top : top + STRIP])
        levels = rounding_steps(tone).count(strip) if pattern is None else dithered(strip, tone, top, pattern)
        into, known = pixels[top : top + STRIP], strip[..., 0] == strip[..., 0]
        if known.all():
            into[..., 2::-1], into[..., 3] = levels, 255
        else:
            into[known] = np.insert(levels[known][:, ::-1], 3, 255, axis=-1)


def dithered(light: np.ndarray, tone: str, top: int, pattern: np.ndarray) -> np.ndarray:
    """Return the levels of some lines of a picture, the first of which is line `top`, dithered by thresholds."""
    of_level, per_light = tone_named(tone).light, light_to_levels(tone)
    levels = level_steps(tone).count(light)
    share = (light - of_level.take(levels)) * per_light.take(levels)
    rows, columns = np.arange(top, top + len(light)) % SIZE, np.arange(light.shape[1]) % SIZE
    levels += share > pattern[np.ix_(rows, columns)][..., None]
    return levels


@cache
def rounding_steps(tone: str) -> Steps:
    """The light from which on each level is the nearest."""
    return Steps(tone_named(tone).halfway)


@cache
def level_steps(tone: str) -> Steps:
    """The light of each level."""
    return Steps(tone_named(tone).light[1:])


@cache
def light_to_levels(tone: str) -> np.ndarray:
    """Levels by light, from each level to the next; 0 for the highest, (256,)."""
    return np.append(1 / np.diff(tone_named(tone).light), 0.0)


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
    counts = np.bincount(pixels[..., :3].ravel(), minlength=LEVELS)
    return sqrt(float(counts @ variances) / max(counts.sum(), 1))
