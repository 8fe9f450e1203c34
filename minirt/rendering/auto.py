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
AIM = 0.95  # of the square of an error: what is aimed at, so that it need not be tried again
LEAST_SHARE = 0.25  # of the sum of squares, which is left by a round
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
            goal = max(AIM * error**2, LEAST_SHARE * squared)
            c = coefficients(self.halves, self.doublings, self.contrast())
            new = allocate(c, self.doublings, goal / squared, MOST, budget)
            before = now
        return self.reached(perf_counter() - start)

    def grow(self, new: np.ndarray, end: float) -> bool:
        """Add samples until the packets have as many doublings, or it is later than `end`. False when cancelled."""
        changed = new > self.doublings
        for doubling in range(self.doublings.min(), new.max()):
            wanted = (self.doublings <= doubling) & (doubling < new)
            if not self.double(doubling, wanted):
                return False
            self.doublings[wanted] += 1
            if perf_counter() > end:
                break
        self.halves.compare(changed)
        return True

    def double(self, doubling: int, wanted: np.ndarray) -> bool:
        """Double the samples of the `wanted` packets, which have 2^doubling, or none where that is -1. False when
        cancelled."""
        points = sobol(2**doubling, 2 ** (doubling + 1)) if doubling >= 0 else sobol(0, 1)
        for half, mean in enumerate(self.halves.means):
            light = self.halves.scratch if doubling >= 0 else mean
            for each, shifts in enumerate(self.shifts[half]):
                packets = wanted & (self.classes == each)
                if packets.any() and not self.draw(shifted(points, shifts), packets, light):
                    return False
            if doubling >= 0:
                self.halves.add(half, wanted)
        return True

    def contrast(self) -> np.ndarray:
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
