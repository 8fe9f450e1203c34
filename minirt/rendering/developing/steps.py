"""Counts how many of some increasing thresholds numbers have reached: a tenth of the time of a binary search."""

from __future__ import annotations

from math import inf

import numpy as np

KEPT_BITS = 8  # of the 52 bits of a float64's fraction: 256 cells between a power of two and the next


class Steps:
    """At most 255 increasing thresholds above 0, and a table of cells, each with at most one threshold.

    The highest bits of a number are the index of its cell.
    """

    def __init__(self, thresholds: np.ndarray) -> None:
        self.low, self.high = float(thresholds[0]) / 2, float(thresholds[-1])
        self.first, last = cells_of(np.array([self.low, self.high])).tolist()
        edges = (np.arange(self.first, last + 2) << (52 - KEPT_BITS)).view(np.float64)
        reached = np.searchsorted(thresholds, edges, "left")
        assert (np.diff(reached) <= 1).all(), "two thresholds in a cell"
        self.reached = reached[:-1].astype(np.uint8)  # thresholds below each cell
        self.next = np.append(thresholds, inf)

    def count(self, numbers: np.ndarray) -> np.ndarray:
        """Return how many thresholds each number is not below, uint8; numbers are float64, and NaN gives anything."""
        cells = cells_of(np.clip(numbers, self.low, self.high)) - self.first
        counts: np.ndarray = self.reached.take(cells, mode="clip")
        counts += numbers >= self.next.take(counts)
        return counts


def cells_of(numbers: np.ndarray) -> np.ndarray:
    """Return the highest bits of positive float64 numbers, which increase with the numbers."""
    cells: np.ndarray = numbers.view(np.int64) >> (52 - KEPT_BITS)
    return cells
