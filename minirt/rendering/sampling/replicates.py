"""A picture that is made twice, independently, so that the difference tells the error.

Both halves take the mean of as many samples a pixel, at places that were shifted independently. Where they differ by d,
the expected square of the error of their mean is d^2 / 4, however that falls with the number of samples. This is so
only where d did not decide how many samples there are: who stops when the halves happen to agree reports too little.
So the pixels of a packet take turns, as on a chessboard. The black ones, guides, decide where more samples go; the
white ones, judges, whose shifts know nothing of those of the guides, tell the error.
"""

from __future__ import annotations

import numpy as np

from minirt.kernel.frame import PACKET_HEIGHT

STRIP, CHUNK = 8, 1024  # rows of packets, and packets, worked on in one go: what they take fits a processor's cache


class Replicates:
    """Two means of the light of every pixel, in packets of `across` by DOWN pixels, and how far they differ.

    `means` and `fresh`, what is to be added to them, are (2, h, w, 3), h and w rounded up to whole packets.
    """

    def __init__(self, height: int, width: int, across: int) -> None:
        self.height, self.width, self.across = height, width, across
        self.packets = rows, columns = -(-height // PACKET_HEIGHT), -(-width // across)
        self.means = np.zeros((2, rows * PACKET_HEIGHT, columns * across, 3))
        self.fresh = np.zeros(self.means.shape)
        self.guides = np.zeros(self.packets)  # squared errors of their mean: the sum over the guides of a packet
        self.judges = np.zeros(self.packets)
        self.judged = 3 * -(-height * width // 2)  # numbers that the judges' sums are of

    def by_packet(self, light: np.ndarray) -> np.ndarray:
        """A view of (2, h, w, 3) as (2, rows, DOWN, columns, 3 * across)."""
        rows, columns = self.packets
        return light.reshape(2, rows, PACKET_HEIGHT, columns, 3 * self.across)

    def compare(self) -> None:
        """Find the errors of all packets."""
        one, other = self.by_packet(self.means).swapaxes(2, 3)
        for top in range(0, len(one), STRIP):
            here = slice(top, top + STRIP)
            self.judges[here], self.guides[here] = squared_errors(one[here], other[here], self.across)

    def add(self, wanted: np.ndarray, weights: np.ndarray) -> None:
        """Add what is fresh in the `wanted` packets, with a weight in [0, 1], and find their errors."""
        mean, fresh = self.by_packet(self.means), self.by_packet(self.fresh)
        rows, columns = np.nonzero(wanted)
        for first in range(0, len(rows), CHUNK):
            here = rows[first : first + CHUNK], columns[first : first + CHUNK]
            place = slice(None), here[0], slice(None), here[1]
            both = mean[place]  # (packets, 2, DOWN, 3 * across)
            both += (fresh[place] - both) * weights[here][:, None, None, None]
            mean[place] = both
            self.judges[here], self.guides[here] = squared_errors(both[:, 0], both[:, 1], self.across)

    @property
    def squared_error(self) -> float:
        """The expected mean of the squares of the errors of the picture."""
        return float(self.judges.sum()) / self.judged

    def finish(self, pixels: np.ndarray, linear: np.ndarray) -> None:
        """Put the mean of both halves into a picture, uint8 (h, w, 4) in the order blue, green, red, alpha, and, where
        that has rows, into `linear` (h, w, 3)."""
        pixels[..., 3] = 255
        for top in range(0, self.height, STRIP * PACKET_HEIGHT):
            here = slice(top, min(top + STRIP * PACKET_HEIGHT, self.height))
            light = (self.means[0, here, : self.width] + self.means[1, here, : self.width]) / 2
            if len(linear):
                linear[here] = light
            pixels[here, :, 2::-1] = np.nan_to_num(shown(light)) * 255 + 0.5


def squared_errors(one: np.ndarray, other: np.ndarray, across: int) -> tuple[np.ndarray, np.ndarray]:
    """Of the mean of two halves of packets (..., DOWN, 3 * across): the sums over judges and over guides."""
    differences = shown(one) - shown(other)
    differences *= differences
    colour = np.add.outer(np.arange(PACKET_HEIGHT), np.repeat(np.arange(across), 3)) % 2
    judges, guides = (np.einsum("...yx,yx->...", differences, (colour == each) / 4) for each in (0, 1))
    return np.nan_to_num(judges), np.nan_to_num(guides)


def shown(light: np.ndarray) -> np.ndarray:
    """Light as far as a picture shows it."""
    clamped: np.ndarray = np.clip(light, 0.0, 1.0)
    return clamped
