"""Which pixels of a picture need more samples: those at edges of objects, of shadows, of what is drawn on surfaces.

All of these show as contrast between neighbouring pixels (Whitted, An improved illumination model for shaded display,
1980, samples anew where neighbours differ).
"""

from __future__ import annotations

import numpy as np

from minirt.kernel.frame import DOWN

CONTRAST = 6  # levels of 255 by which neighbours differ at an edge


def contrasts(pixels: np.ndarray, least: int = CONTRAST) -> np.ndarray:
    """Pixels (h, w) of which a neighbour to the left, right, above or below differs by more than `least` levels in a
    colour; `pixels` is uint8 (h, w, 3 or more)."""
    colours = pixels[..., :3]
    edge = np.zeros(colours.shape[:2], bool)
    for a, b, at_a, at_b in (
        (colours[:, 1:], colours[:, :-1], edge[:, 1:], edge[:, :-1]),
        (colours[1:], colours[:-1], edge[1:], edge[:-1]),
    ):
        differs = (np.maximum(a, b) - np.minimum(a, b) > least).any(axis=-1)
        np.logical_or(at_a, differs, out=at_a)
        np.logical_or(at_b, differs, out=at_b)
    return edge


def packets_of(pixels: np.ndarray, across: int) -> np.ndarray:
    """The packets, so many pixels across, with at least one of the pixels (h, w), as uint8 (rows, columns)."""
    height, width = pixels.shape
    rows, columns = -(-height // DOWN), -(-width // across)
    whole = np.zeros((rows * DOWN, columns * across), bool)
    whole[:height, :width] = pixels
    return np.asarray(whole.reshape(rows, DOWN, columns, across).any(axis=(1, 3)), np.uint8)
