"""Canvas: the frame buffer of a window in memory, which all drawing goes to and the screen is updated from."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Words = NDArray[np.uint32]  # pixels 0xAARRGGBB
Box = tuple[int, int, int, int]  # left, top, right, bottom; right and bottom are outside

OPAQUE = 0xFF000000
LEAST_ALPHA = 0x01000000  # the least word that is not wholly transparent
RED_AND_BLUE = 0x00FF00FF
BLOCK = 16384  # pixels at a time: they and all intermediate values stay in the cache, which is 3 times as fast


class Canvas:
    """(h, w, 4) uint8 pixels, BGRA, and the bounding box of all changes since the last `take_changes`.

    alpha: what is drawn is blended by its alpha; otherwise it is copied. Single pixels are collected in a layer of
    their own, which any other access blends into the canvas: of two at the same place only the last one counts.
    """

    def __init__(self, width: int, height: int, *, alpha: bool = False) -> None:
        self.width = width
        self.height = height
        self._words = np.full((height, width), OPAQUE, "<u4")  # 0xAARRGGBB
        self._pixels: NDArray[np.uint8] = self._words.view(np.uint8).reshape(height, width, 4)
        self._alpha = alpha
        self._layer = np.zeros((height, width), "<u4") if alpha else self._words
        self._points = self._layer.reshape(-1).view(np.uint32).data  # 3 times as fast as the array
        self._changes: Box | None = (0, 0, width, height)
        self._left, self._top, self._right, self._bottom = width, height, 0, 0  # box of the single pixels

    @property
    def pixels(self) -> NDArray[np.uint8]:
        """The picture with all that was drawn; who writes into it calls `touch`."""
        self._merge_points()
        return self._pixels

    @property
    def changes(self) -> Box | None:
        """The box of changes, or None."""
        self._merge_points()
        return self._changes

    def clear(self) -> None:
        """Fill the canvas with black."""
        self._merge_points()
        self._words[...] = OPAQUE
        self.touch(0, 0, self.width, self.height)

    def point(self, x: int, y: int, color: int) -> None:
        """Draw one pixel of 0xAARRGGBB; pixels outside are ignored."""
        if self._left <= x < self._right and self._top <= y < self._bottom:  # within the box of earlier points
            self._points[y * self.width + x] = color & 0xFFFFFFFF
        elif 0 <= x < self.width and 0 <= y < self.height:
            self._points[y * self.width + x] = color & 0xFFFFFFFF
            self._left, self._right = min(x, self._left), max(x + 1, self._right)
            self._top, self._bottom = min(y, self._top), max(y + 1, self._bottom)

    def put(self, source: NDArray[np.uint8], x: int, y: int) -> None:
        """Draw a picture with its top left corner at x, y, clipped at the borders."""
        self._merge_points()
        left, top = max(x, 0), max(y, 0)
        right, bottom = min(x + source.shape[1], self.width), min(y + source.shape[0], self.height)
        if left < right and top < bottom:
            words = source.view("<u4")[top - y : bottom - y, left - x : right - x, 0]
            if self._alpha:
                blend(self._words[top:bottom, left:right], words)
            else:
                self._words[top:bottom, left:right] = words
            self.touch(left, top, right, bottom)

    def touch(self, left: int, top: int, right: int, bottom: int) -> None:
        """Extend the box of changes by this box, clipped at the borders."""
        left, top, right, bottom = max(left, 0), max(top, 0), min(right, self.width), min(bottom, self.height)
        if left >= right or top >= bottom:
            return
        if self._changes is not None:
            old = self._changes
            left, top, right, bottom = min(left, old[0]), min(top, old[1]), max(right, old[2]), max(bottom, old[3])
        self._changes = left, top, right, bottom

    def take_changes(self) -> Box | None:
        """Return the box of changes, or None, and reset it."""
        changes, self._changes = self.changes, None
        return changes

    def _merge_points(self) -> None:
        if self._right:
            left, top, right, bottom = self._left, self._top, self._right, self._bottom
            if self._alpha:
                layer = self._layer[top:bottom, left:right]
                blend(self._words[top:bottom, left:right], layer)
                layer[...] = 0
            self.touch(left, top, right, bottom)
            self._left, self._top, self._right, self._bottom = self.width, self.height, 0, 0


def stretch(pixels: NDArray[np.uint8], width: int, height: int) -> NDArray[np.uint8]:
    """Resample a picture to another size by nearest neighbour."""
    source_height, source_width = pixels.shape[:2]
    rows = (2 * np.arange(height) + 1) * source_height // (2 * height)
    columns = (2 * np.arange(width) + 1) * source_width // (2 * width)
    return pixels.take(columns, axis=1).take(rows, axis=0)  # 6 times as fast as both at once


def blend(below: Words, source: Words) -> None:
    """Blend a picture into another of the same shape (h, w), in place. The result is opaque."""
    rows = max(1, BLOCK // max(1, source.shape[1]))
    for top in range(0, source.shape[0], rows):
        _blend_block(below[top : top + rows], source[top : top + rows])


def _blend_block(below: Words, source: Words) -> None:
    """Blend `source` into `below`, (h, w) each, in place; below a wholly transparent source nothing changes.

    A source that is wholly opaque or wholly transparent takes a fraction of the time.
    """
    if source.min() >= OPAQUE:
        below[...] = source
    elif source.max() >= LEAST_ALPHA:
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
