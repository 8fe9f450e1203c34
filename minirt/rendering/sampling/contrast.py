"""Contrast between neighbouring pixels, which tells where more samples are needed, and what they will change.

Errors of few samples sit at edges of objects, shadows and textures, all of which show as contrast (Whitted, An improved
illumination model for shaded display, 1980, takes more samples where neighbours differ).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from math import sqrt

import numpy as np

from minirt.kernel.machine_code import functions
from minirt.kernel.machine_code.library import Call
from minirt.kernel.pixels import PACKET_HEIGHT
from minirt.rendering.outcome import ERROR_EXPONENT
from minirt.rendering.tone_mapping import PLAIN, rounding_error, tone_named

Job = Callable[[], object]

CLASSES = 9  # class k > 0 differs by at least 2^(k - 1) levels of 255, but by less than 2^k; class 0 not at all
CLASS_OF = np.array([value.bit_length() for value in range(256)], np.uint8)
EDGE = 4  # the class from which on neighbours are taken to differ by an edge: by 8 levels


def contrast_classes(
    pixels: np.ndarray, packet_width: int, run: Callable[[list[Job]], object], threads: int
) -> tuple[np.ndarray, np.ndarray]:
    """The class of each packet, uint8 (rows, columns), by the greatest difference of a colour from a neighbour above,
    below, left or right; and the number of packets of each class. `pixels` is C-contiguous uint8 (h, w, 4), all equally
    opaque; `run` runs jobs, one for each of the threads, side by side."""
    height, width, _ = pixels.shape
    beyond = -height % PACKET_HEIGHT, -width % packet_width
    if any(beyond):
        pixels = np.pad(pixels, ((0, beyond[0]), (0, beyond[1]), (0, 0)), "edge")
    lines = pixels.reshape(len(pixels), -1)
    classes = np.empty((len(lines) // PACKET_HEIGHT, pixels.shape[1] // packet_width), np.uint8)
    counter, counts = np.zeros(1, np.int64), np.zeros((threads, CLASSES), np.int64)

    def job(thread: int) -> None:
        seen = np.empty((2, lines.shape[1]), np.uint8)
        functions.classify(counter, lines, seen, seen.view(np.uint64), CLASS_OF, classes, counts[thread])

    run([partial(job, thread) for thread in range(threads)])
    return classes, counts.sum(axis=0)


@cache
def classify_call() -> Call:
    """The call of the compiled function, to look for its kernel."""
    numbers, none = np.zeros(1, np.int64), np.zeros((0, 0), np.uint8)
    return functions.classify.call(numbers, none, none, np.zeros((0, 0), np.uint64), CLASS_OF, none, numbers)


SQUARED_ROUNDING = 1 / 12  # mean squared error of rounding to whole levels
LINES = 64  # lines processed at once: their data fits a processor's cache, which takes two thirds of the time


def estimated_error(
    before: np.ndarray,
    after: np.ndarray,
    fewer: int,
    samples: int,
    is_wanted: Callable[[], bool] = lambda: True,
    tone: str = PLAIN,
) -> float | None:
    """The RMSE of a picture `after` with `samples`, given the picture `before` with `fewer`.

    It is the error of `minirt.rendering.outcome` and that of rounding. Both are uint8 (h, w, 4), equally
    opaque. Their squared difference is the sum of both squared errors, whose ratio is that of the numbers of
    samples to the power of -1.5. With another tone than plain the error is that of the light of the levels, clamped to
    [0, 1]. None as soon as `is_wanted` says no, which is asked a few times a millisecond.
    """
    total, light = 0.0, np.minimum(tone_named(tone).light, 1.0)
    for top in range(0, len(before), LINES):
        if not is_wanted():
            return None
        a, b = before[top : top + LINES], after[top : top + LINES]
        if tone == PLAIN:
            difference = np.maximum(a, b) - np.minimum(a, b)
            total += int(np.square(difference, dtype=np.uint16).sum(dtype=np.int64))
        else:
            total += float(np.square(light.take(a[..., :3]) - light.take(b[..., :3])).sum()) * 255**2
    ratio = (samples / fewer) ** ERROR_EXPONENT
    rounding = SQUARED_ROUNDING if tone == PLAIN else (255 * rounding_error(after, tone, dither=False)) ** 2
    return sqrt(total / (before.size * 3 / 4) / (1 + ratio) + rounding) / 255
