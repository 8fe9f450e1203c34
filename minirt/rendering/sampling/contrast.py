"""Contrast of the packets of a picture: how far neighbouring pixels differ.

Errors of few samples sit at edges of objects, shadows and textures, all of which show as contrast.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from minirt.kernel.frame import PACKET_HEIGHT

Job = Callable[[], object]

CLASSES = 9  # class k > 0 differs by at least 2^(k - 1) levels of 255, but by less than 2^k; class 0 not at all
CLASS_OF = np.array([value.bit_length() for value in range(256)], np.uint8)
STRIP = 16  # rows of packets processed at once: their data fits a processor's cache


def contrast_classes(pixels: np.ndarray, packet_width: int, run: Callable[[list[Job]], object]) -> np.ndarray:
    """The class of each packet, uint8 (rows, columns), by the greatest difference of a colour from a neighbour above,
    below, left or right. `pixels` is C-contiguous uint8 (h, w, 4), all equally opaque; `run` runs jobs side by side."""
    height, width, _ = pixels.shape
    beyond = -height % PACKET_HEIGHT, -width % packet_width
    if any(beyond):
        pixels = np.pad(pixels, ((0, beyond[0]), (0, beyond[1]), (0, 0)), "edge")
    lines = pixels.reshape(len(pixels), -1)
    classes = np.zeros((len(lines) // PACKET_HEIGHT, pixels.shape[1] // packet_width), np.uint8)
    middle = -(-len(classes) // 2)
    run([partial(classify, lines, classes, 0, middle), partial(classify, lines, classes, middle, len(classes))])
    return classes


def classify(lines: np.ndarray, classes: np.ndarray, first: int, last: int) -> None:
    """Find the classes of some rows of packets of a picture, uint8 (lines, 4 * width)."""
    for row in range(first, last, STRIP):
        end = min(row + STRIP, last)
        above, below = min(row, 1), min(len(classes) - end, 1)
        strip = lines[row * PACKET_HEIGHT - above : end * PACKET_HEIGHT + below]
        classes[row:end] = classes_of_strip(strip, above, classes.shape[1])


def classes_of_strip(lines: np.ndarray, above: int, columns: int) -> np.ndarray:
    """The classes of the packets of a strip of lines, uint8 (lines, 4 * width), that begins with `above` lines of the
    strip before it, and may end with a line of the next."""
    bits = np.zeros(lines.shape, np.uint8)
    for there, here in ((np.s_[:, 4:], np.s_[:, :-4]), (np.s_[1:], np.s_[:-1])):
        difference = np.maximum(lines[there], lines[here])
        difference -= np.minimum(lines[there], lines[here])
        bits[there] |= difference
        bits[here] |= difference
    # The highest bit of all differences is that of the greatest: "or" is as good as a maximum, for 8 bytes at once.
    rows = (len(lines) - above) // PACKET_HEIGHT
    words = bits[above : above + rows * PACKET_HEIGHT].view(np.uint64)
    words = np.bitwise_or.reduce(words.reshape(rows, PACKET_HEIGHT, -1), axis=1)
    parts = words.shape[1] // columns
    found = words[:, ::parts].copy()
    for part in range(1, parts):
        found |= words[:, part::parts]
    for shift in (32, 16, 8):
        found |= found >> np.uint64(shift)
    classes: np.ndarray = CLASS_OF[found.astype(np.uint8)]
    return classes
