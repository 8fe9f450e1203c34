"""As many samples as an error asks for, or as fit a time, where they are needed."""

from __future__ import annotations

from collections.abc import Callable
from math import inf, sqrt
from time import perf_counter

import numpy as np

from minirt.kernel.frame import DOWN
from minirt.rendering.adaptive import edge_packets
from minirt.rendering.allocation import allocate, coefficients
from minirt.rendering.reached import Reached
from minirt.rendering.replicates import Replicates
from minirt.rendering.sobol import digital_shifts, shifted, sobol

Draw = Callable[[np.ndarray, np.ndarray, np.ndarray], bool]  # places, packets, light: False when cancelled

CLASSES = 8  # of packets, each with shifts of its own: what an edge along a row of pixels meets
MOST = 15  # doublings of the samples of each half
LEVELS = (1, 4, 16, 64)
LEAST_SHARE, MOST_SHARE = 0.25, 0.8  # of the sum of squares that are left by a round
SPENT = 0.5  # of the time that is left, by a round


class Auto:
    """A picture in both halves, and how many samples each packet has."""

    def __init__(self, draw: Draw, pixels: np.ndarray, across: int) -> None:
        self.draw, self.pixels = draw, pixels
        height, width, _ = pixels.shape
        self.halves = Replicates(height, width, across)
        self.doublings = np.full(self.halves.packets, -1)  # a packet has 2^doublings samples in each half
        self.shifts = digital_shifts(2, CLASSES, DOWN * across)
        rows, columns = self.halves.packets
        self.classes = np.add.outer(3 * np.arange(rows), np.arange(columns)) % CLASSES

    def reach(self, error: float, seconds: float) -> Reached | None:
        """Render until the estimated error is as small, or as many seconds have passed: whatever comes first, but at
        least one sample in each half of every pixel. None when cancelled."""
        start = perf_counter()
        end = start + seconds
        new, before = np.zeros_like(self.doublings), start
        while (new > self.doublings).any():
            spent = self.price(new) - self.price(self.doublings)
            if not self.grow(new, end):
                return None
            now, squared = perf_counter(), self.halves.squared_error
            if squared <= error**2 or now >= end:
                break
            budget = SPENT * (end - now) / (now - before) * spent if seconds < inf else inf
            share = min(max(error**2 / squared, LEAST_SHARE), MOST_SHARE)
            c = coefficients(self.halves, self.doublings, self.contrast)
            new = allocate(c, self.doublings, share, MOST, budget)
            before = now
        return self.reached(perf_counter() - start)

    def grow(self, new: np.ndarray, end: float) -> bool:
        """Add samples until the packets have as many doublings, or it is later than `end`. False when cancelled."""
        old = self.doublings.copy()
        for before, after in sorted({*zip(old.ravel().tolist(), new.ravel().tolist(), strict=True)}):
            wanted = (old == before) & (new == after)
            if before == after:
                continue
            if not self.add(before, after, wanted):
                return False
            self.doublings[wanted] = after
            if perf_counter() > end:
                break
        return True

    def add(self, before: int, after: int, wanted: np.ndarray) -> bool:
        """Give the `wanted` packets 2^after samples in each half; they have 2^before, or none where that is -1. False
        when cancelled."""
        is_first = before < 0
        points = sobol(0 if is_first else 2**before, 2**after)
        for light, shifts in zip(self.halves.means if is_first else self.halves.fresh, self.shifts, strict=True):
            for each in range(CLASSES):
                packets = wanted & (self.classes == each)
                if packets.any() and not self.draw(shifted(points, shifts[each]), packets, light):
                    return False
        if is_first:
            self.halves.compare()
            self.contrast = self.contrasts()
        else:
            self.halves.add(wanted, 1 - 2.0 ** (before - after))
        return True

    def contrasts(self) -> np.ndarray:
        """For each packet how many of the LEVELS neighbouring pixels differ by."""
        across = self.halves.across
        found = [np.concatenate(list(edge_packets(self.pixels, across, least))) for least in LEVELS]
        return np.sum(found, axis=0, dtype=np.int64)

    def price(self, doublings: np.ndarray) -> float:
        """The samples of all packets in a half."""
        return float((2.0**doublings)[doublings >= 0].sum())

    def reached(self, seconds: float) -> Reached:
        """What that is, after so many seconds."""
        most = 2 * 2 ** int(self.doublings.max())
        mean = 2 * self.price(self.doublings) / self.doublings.size
        return Reached(mean, most, sqrt(self.halves.squared_error), seconds)
