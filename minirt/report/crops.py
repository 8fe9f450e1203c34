"""Crops of a picture that represent it: errors are measured in these where the whole picture would take too long."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from minirt.kernel.pixels import PACKET_HEIGHT
from minirt.rendering.frame import plan_of

SIDE = 64  # pixels along an edge of a crop


class Crops(NamedTuple):
    """Squares of a picture at their true pixel size, put beside each other in rows; or the whole picture."""

    height: int  # of the picture, in pixels
    width: int
    chosen: np.ndarray | None = None  # numbers of squares, row by row; None: the whole picture
    across: int = 1  # crops beside each other

    @property
    def side(self) -> tuple[int, int]:
        """Rows and columns of a crop."""
        return (min(SIDE, self.height), min(SIDE, self.width)) if self.chosen is not None else (self.height, self.width)

    def of(self, picture: np.ndarray) -> np.ndarray:
        """Cut the crops out of a picture (h, w, k)."""
        if self.chosen is None:
            return picture
        crops = squares_of(picture, self.side)[self.chosen]
        rows = crops.reshape(-1, self.across, *crops.shape[1:]).swapaxes(1, 2)
        return rows.reshape(rows.shape[0] * self.side[0], self.across * self.side[1], picture.shape[2])

    def plan(self, packet_width: int, samples: int) -> np.ndarray:
        """Return the plan of `minirt.kernel.frame.frame` that draws the packets of the crops with so many samples."""
        pixels = self.of(np.arange(self.height * self.width).reshape(self.height, self.width, 1))
        y, x = np.divmod(pixels.ravel(), self.width)
        columns = -(-self.width // packet_width)
        return plan_of(np.unique(y // PACKET_HEIGHT * columns + x // packet_width), columns, (0, samples, 0))


def squares_of(picture: np.ndarray, side: tuple[int, int]) -> np.ndarray:
    """Cut a picture (h, w, k) into squares (n, *side, k), row by row; what is left at the lower and the right border,
    less than a square, is in none."""
    rows, columns = picture.shape[0] // side[0], picture.shape[1] // side[1]
    whole = picture[: rows * side[0], : columns * side[1]].reshape(rows, side[0], columns, side[1], -1)
    return whole.swapaxes(1, 2).reshape(rows * columns, *side, -1)


def representative(squares: np.ndarray, most: int) -> Crops:
    """Choose crops of at most `most` pixels together, given the squared error of each pixel of the picture, (h, w); the
    whole picture where it has no more pixels, or fewer squares than are wanted.

    They are every n-th square in the order of errors, beginning in the middle of the first n: systematic sampling of
    strata (Cochran, Sampling Techniques, 1977). The RMSE of a picture in them is within a tenth of that of the whole
    picture (three scenes, 1 to 16 samples a pixel, 32 of 240 squares).
    """
    height, width = squares.shape
    whole, some = Crops(height, width), Crops(height, width, np.zeros(0, int))
    errors = squares_of(squares[..., None], some.side).sum(axis=(1, 2, 3))
    count = most // (some.side[0] * some.side[1])
    across = max(1, round((2 * count) ** 0.5))  # about twice as many as below each other
    count -= count % across
    if squares.size <= most or not 0 < count < len(errors):
        return whole
    middles = ((np.arange(count) + 0.5) * len(errors) / count).astype(int)
    return whole._replace(chosen=np.sort(np.argsort(errors, kind="stable")[middles]), across=across)
