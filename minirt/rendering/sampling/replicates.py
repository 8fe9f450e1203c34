"""Two independent replicates of a picture, whose difference estimates the error.

Both halves take the mean of as many samples a pixel, at positions that were shifted independently. Where they differ by
d, the expected squared error of their mean is d^2 / 4, however the error falls with the number of samples. This holds
only if d did not decide the number of samples: who stops when the halves happen to agree underestimates the error. So
the pixels of a packet alternate, as on a chessboard. The black ones, the guides, decide where more samples go; the
white ones, the judges, whose shifts are independent of those of the guides, estimate the error.
"""

from __future__ import annotations

import numpy as np

from minirt.kernel.frame import PACKET_HEIGHT

STRIP, CHUNK = 8, 1024  # rows of packets, and packets, processed at once: their data fits a processor's cache


class Replicates:
    """Two means of the light of every pixel, in packets of `packet_width` by PACKET_HEIGHT pixels, and their squared errors.

    `means` and `new_means`, which are to be added to them, are (2, h, w, 3), h and w rounded up to whole packets.
    """

    def __init__(self, height: int, width: int, packet_width: int) -> None:
        self.height, self.width, self.packet_width = height, width, packet_width
        self.packets = rows, columns = -(-height // PACKET_HEIGHT), -(-width // packet_width)
        self.means = np.zeros((2, rows * PACKET_HEIGHT, columns * packet_width, 3))
        self.new_means = np.zeros(self.means.shape)
        self.guides = np.zeros(self.packets)  # squared errors of the mean of both halves, summed over a packet's guides
        self.judges = np.zeros(self.packets)  # and over its judges
        self.judged = 3 * -(-height * width // 2)  # numbers that all judges have together

    def by_packet(self, light: np.ndarray) -> np.ndarray:
        """View light (2, h, w, 3) as (2, rows, PACKET_HEIGHT, columns, 3 * packet_width)."""
        rows, columns = self.packets
        return light.reshape(2, rows, PACKET_HEIGHT, columns, 3 * self.packet_width)

    def compare(self) -> None:
        """Compute the squared errors of all packets."""
        one, other = self.by_packet(self.means).swapaxes(2, 3)
        for top in range(0, len(one), STRIP):
            strip = slice(top, top + STRIP)
            self.judges[strip], self.guides[strip] = squared_errors(one[strip], other[strip], self.packet_width)

    def add(self, wanted: np.ndarray, weights: np.ndarray) -> None:
        """Mix the new means of the `wanted` packets into the means, with weights in [0, 1], and update their errors."""
        means, new_means = self.by_packet(self.means), self.by_packet(self.new_means)
        rows, columns = np.nonzero(wanted)
        for first in range(0, len(rows), CHUNK):
            chunk = rows[first : first + CHUNK], columns[first : first + CHUNK]
            index = slice(None), chunk[0], slice(None), chunk[1]
            mixed = means[index]  # (packets, 2, PACKET_HEIGHT, 3 * packet_width)
            mixed += (new_means[index] - mixed) * weights[chunk][:, None, None, None]
            means[index] = mixed
            self.judges[chunk], self.guides[chunk] = squared_errors(mixed[:, 0], mixed[:, 1], self.packet_width)

    @property
    def squared_error(self) -> float:
        """The estimated mean squared error of the picture."""
        return float(self.judges.sum()) / self.judged

    def finish(self, pixels: np.ndarray, linear: np.ndarray) -> None:
        """Write the mean of both halves into a picture, uint8 (h, w, 4) in the order blue, green, red, alpha, and into
        `linear` (h, w, 3) if that has rows."""
        pixels[..., 3] = 255
        for top in range(0, self.height, STRIP * PACKET_HEIGHT):
            strip = slice(top, min(top + STRIP * PACKET_HEIGHT, self.height))
            light = (self.means[0, strip, : self.width] + self.means[1, strip, : self.width]) / 2
            if len(linear):
                linear[strip] = light
            pixels[strip, :, 2::-1] = np.nan_to_num(clamped(light)) * 255 + 0.5


def squared_errors(one: np.ndarray, other: np.ndarray, packet_width: int) -> tuple[np.ndarray, np.ndarray]:
    """Sum the squared errors of the mean of two halves of packets (..., PACKET_HEIGHT, 3 * packet_width): judges and guides."""
    differences = clamped(one) - clamped(other)
    differences *= differences
    colour = np.add.outer(np.arange(PACKET_HEIGHT), np.repeat(np.arange(packet_width), 3)) % 2  # of the chessboard
    judges, guides = (np.einsum("...yx,yx->...", differences, (colour == each) / 4) for each in (0, 1))
    return np.nan_to_num(judges), np.nan_to_num(guides)


def clamped(light: np.ndarray) -> np.ndarray:
    """Clamp light to [0, 1], the range that a picture shows."""
    within: np.ndarray = np.clip(light, 0.0, 1.0)
    return within
