"""Which pixels of a picture need more samples: those at edges of objects, of shadows, of what is drawn on surfaces.

All of these show as contrast between neighbouring pixels (Whitted, An improved illumination model for shaded display,
1980, samples anew where neighbours differ).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from minirt.kernel.frame import PACKET_HEIGHT

CONTRAST = 6  # levels of 255 by which neighbours differ at an edge
STRIP = (
    16 * PACKET_HEIGHT
)  # lines looked at in one go: what they take fits a processor's cache, a third of the time of all at once


def edge_packets(pixels: np.ndarray, across: int, least: int = CONTRAST) -> Iterator[np.ndarray]:
    """The packets, so many pixels across, with a pixel at an edge: uint8 (rows, columns), a strip of the picture at a
    time, so that whoever asks may stop in between. `pixels` is C-contiguous uint8 (h, w, 4)."""
    for top in range(0, len(pixels), STRIP):
        seen = pixels[max(top - 1, 0) : top + STRIP + 1]  # with a line above and one below
        yield packets_of(contrasts(seen, least)[min(top, 1) :][:STRIP], across)


def contrasts(pixels: np.ndarray, least: int = CONTRAST) -> np.ndarray:
    """Pixels (h, w) of which a neighbour to the left, right, above or below differs by more than `least` levels in a
    colour; `pixels` is C-contiguous uint8 (h, w, 4), all equally opaque."""
    height, width, _ = pixels.shape
    lines = pixels.reshape(height, 4 * width)
    beside = differ(lines[:, 4:], lines[:, :-4], least)
    below = differ(lines[1:], lines[:-1], least)
    edge = np.zeros((height, width), bool)
    edge[:, 1:] |= beside
    edge[:, :-1] |= beside
    edge[1:] |= below
    edge[:-1] |= below
    return edge


def differ(a: np.ndarray, b: np.ndarray, least: int) -> np.ndarray:
    """Which pixels of two pictures, uint8 (h, 4 * w), differ by more than `least` levels: (h, w)."""
    far = np.maximum(a, b) - np.minimum(a, b) > least
    differs: np.ndarray = far.view(np.uint32) != 0  # any of the bytes of a pixel: 40 times as fast as `any`
    return differs


def packets_of(pixels: np.ndarray, across: int) -> np.ndarray:
    """The packets, so many pixels across, with at least one of the pixels (h, w), as uint8 (rows, columns)."""
    height, width = pixels.shape
    rows, columns = -(-height // PACKET_HEIGHT), -(-width // across)
    whole = np.zeros((rows * PACKET_HEIGHT, columns * across), bool)
    whole[:height, :width] = pixels
    found = np.zeros((rows, columns), bool)
    for y in range(PACKET_HEIGHT):
        for x in range(across):
            found |= whole[y::PACKET_HEIGHT, x::across]
    return found.view(np.uint8)
