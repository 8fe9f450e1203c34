"""Alpha blending of pictures: SRC_ALPHA, ONE_MINUS_SRC_ALPHA, rounded to the nearest integer as a GPU rounds it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Words = NDArray[np.uint32]  # pixels 0xAARRGGBB

OPAQUE = 0xFF000000
RED_AND_BLUE = 0x00FF00FF
BLOCK = 16384  # pixels at a time: they and all intermediate values stay in the cache, which is 3 times as fast


def blend(below: Words, source: Words) -> None:
    """Blend a picture into another of the same shape (h, w), in place. The result is opaque."""
    rows = max(1, BLOCK // max(1, source.shape[1]))
    for top in range(0, source.shape[0], rows):
        _blend_block(below[top : top + rows], source[top : top + rows])


def _blend_block(below: Words, source: Words) -> None:
    """Blend pixels; those that are all opaque or all transparent take a fraction of the time."""
    if source.min() >= OPAQUE:
        below[...] = source
    elif source.max() > 0x00FFFFFF:
        alpha = source >> 24
        rest = 255 - alpha
        # A sum is at most 255 * 255, so that red and blue share a word. With t = sum + 128, (t + t / 256) / 256 is
        # sum / 255 rounded to nearest, for every such sum.
        mixed = (source & RED_AND_BLUE) * alpha
        mixed += (below & RED_AND_BLUE) * rest
        mixed += 0x00800080
        mixed += mixed >> 8 & RED_AND_BLUE
        mixed >>= 8
        mixed &= RED_AND_BLUE
        green = (source >> 8 & 0xFF) * alpha
        green += (below >> 8 & 0xFF) * rest
        green += 0x80
        green += green >> 8
        green &= 0xFF00
        mixed |= green
        mixed |= OPAQUE
        below[...] = mixed
