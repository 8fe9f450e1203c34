"""A picture that is made twice, independently, so that the difference tells the error.

Both halves take the mean of as many samples a pixel, at places that were shifted independently; where they differ by d
the expected square of the error of their mean is d^2 / 4, whatever the error falls like with the number of samples. That
holds for a packet only as long as its difference did not decide how many samples it got: who stops when the halves happen
to agree reports too little. So the pixels of a packet take turns, as on a chessboard. One half of them, the guides, decide
where more samples go; the others, the judges, are shifted independently of them and tell the error.
"""

from __future__ import annotations

import numpy as np

from minirt.kernel.frame import DOWN

CHUNK = 2048  # packets compared in one go, which fit a processor's cache


class Replicates:
    """Two means of the light of every pixel, kept by packets of `across` by DOWN pixels."""

    def __init__(self, height: int, width: int, across: int) -> None:
        self.height, self.width, self.across = height, width, across
        self.packets = -(-height // DOWN), -(-width // across)
        rows, columns = self.packets
        self.means = np.zeros((2, rows * DOWN, columns * across, 3))
        self.scratch = np.zeros(self.means.shape[1:])  # what is rendered before it is added
        self.guides = np.zeros(self.packets)  # sums of squared errors of the guides of a packet, and of its judges
        self.judges = np.zeros(self.packets)
        self.judged = 3 * int((np.add.outer(np.arange(height), np.arange(width)) % 2 == 0).sum())  # numbers judged

    def by_packet(self, light: np.ndarray) -> np.ndarray:
        """A view of (h, w, 3) as (rows, DOWN, columns, 3 * across)."""
        rows, columns = self.packets
        return light.reshape(rows, DOWN, columns, 3 * self.across)

    def add(self, half: int, wanted: np.ndarray) -> None:
        """Put what was rendered into the mean of a half in the `wanted` packets: as many samples as it already has."""
        mean, more = self.by_packet(self.means[half]), self.by_packet(self.scratch)
        for row, column in chunks(wanted):
            mean[row, :, column] = (mean[row, :, column] + more[row, :, column]) / 2

    def compare(self, changed: np.ndarray) -> None:
        """Work out the errors of the `changed` packets."""
        one, other = map(self.by_packet, self.means)
        for row, column in chunks(changed):
            difference = shown(one[row, :, column]) - shown(other[row, :, column])
            squares = np.square(difference).reshape(-1, DOWN, self.across, 3) / 4
            self.judges[row, column] = total(squares[:, 0::2, 0::2]) + total(squares[:, 1::2, 1::2])
            self.guides[row, column] = total(squares[:, 0::2, 1::2]) + total(squares[:, 1::2, 0::2])

    @property
    def squared_error(self) -> float:
        """The expected mean of the squares of the errors of all pixels, as far as they show."""
        return float(self.judges.sum()) / self.judged

    @property
    def light(self) -> np.ndarray:
        """The mean of both halves (h, w, 3)."""
        both: np.ndarray = (self.means[0] + self.means[1])[: self.height, : self.width] / 2
        return both


def chunks(wanted: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Rows and columns of the packets that are wanted, some at a time."""
    rows, columns = np.nonzero(wanted)
    return [(rows[i : i + CHUNK], columns[i : i + CHUNK]) for i in range(0, len(rows), CHUNK)]


def shown(light: np.ndarray) -> np.ndarray:
    """Light as far as a picture shows it: in [0, 1], what is no number as black."""
    clamped: np.ndarray = np.fmin(np.fmax(light, 0.0), 1.0)
    return clamped


def total(squares: np.ndarray) -> np.ndarray:
    """Sums over all but the first axis."""
    sums: np.ndarray = squares.sum(axis=(1, 2, 3))
    return sums


def levels(light: np.ndarray) -> np.ndarray:
    """Light (h, w, 3) as a picture, uint8 (h, w, 4) in the order blue, green, red, alpha."""
    pixels = np.full((*light.shape[:2], 4), 255, np.uint8)
    pixels[..., 2::-1] = shown(light) * 255 + 0.5
    return pixels
