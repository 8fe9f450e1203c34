"""Difference between two pictures of a film: formats of loops store only the rectangle that changes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class Rectangle(NamedTuple):
    """Rectangle of pixels, from a column and a row on."""

    x: int
    y: int
    width: int
    height: int

    def of(self, picture: np.ndarray) -> np.ndarray:
        """Return the pixels of the rectangle in a picture."""
        return picture[self.y : self.y + self.height, self.x : self.x + self.width]


ONE_PIXEL = Rectangle(0, 0, 1, 1)


def changed_rectangle(before: np.ndarray | None, now: np.ndarray, step: int = 1) -> Rectangle | None:
    """Return the rectangle outside of which two pictures (h, w, 3) are the same; None where nothing differs.

    It begins at a column and a row that are multiples of `step`. Without a picture before, it is the whole picture.
    """
    height, width = now.shape[:2]
    if before is None:
        return Rectangle(0, 0, width, height)
    changed = (before != now).any(axis=2)
    rows, columns = np.flatnonzero(changed.any(axis=1)), np.flatnonzero(changed.any(axis=0))
    if not len(rows):
        return None
    x, y = int(columns[0]) // step * step, int(rows[0]) // step * step
    return Rectangle(x, y, int(columns[-1]) + 1 - x, int(rows[-1]) + 1 - y)
