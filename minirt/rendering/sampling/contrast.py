"""Contrast classes of the packets of a picture, by how far neighbouring pixels differ.

Errors of few samples sit at edges of objects, shadows and textures, all of which show as contrast.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial

import numpy as np

from minirt.kernel.machine_code import functions
from minirt.kernel.machine_code.library import Call
from minirt.kernel.stored_light import PACKET_HEIGHT

Job = Callable[[], object]

CLASSES = 9  # class k > 0 differs by at least 2^(k - 1) levels of 255, but by less than 2^k; class 0 not at all
CLASS_OF = np.array([value.bit_length() for value in range(256)], np.uint8)


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
