"""As many samples as an error asks for, or as fit a time, where they are needed.

The first round has one sample in each half of every pixel, each of the others what `minirt.rendering.sampling.allocation` finds
worth it, until the estimate of `minirt.rendering.sampling.replicates` is good enough. Where an error is asked for, the picture
depends on nothing else; where a time is asked for, on how fast the rounds were.

What no sample met in any packet of a kind is not known of: a few features that are smaller than a pixel may be missing
in the picture and in the estimate.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf, sqrt
from time import perf_counter
from typing import NamedTuple

import numpy as np

from minirt.kernel.frame import PACKET_HEIGHT
from minirt.rendering.sampling.adaptive import edge_packets
from minirt.rendering.sampling.allocation import CONTRASTS, allocate, coefficients
from minirt.rendering.sampling.outcome import Outcome
from minirt.rendering.sampling.replicates import Replicates
from minirt.rendering.sampling.sobol import digital_shifts, shifted, sobol

CLASSES = 8  # of packets, with shifts of their own, so that an edge along a row of pixels meets as many more of them
LEAST_LEFT, MOST_LEFT = 0.25, 0.8  # of the squared error, by a round
SPENT = 0.4  # of the time that is left, by a round


class Task(NamedTuple):
    """Samples at places of the pixels, (k, pixels of a packet, 2), in the packets where that is not 0."""

    places: np.ndarray
    packets: np.ndarray
    light: np.ndarray  # takes their mean, as `linear` of `minirt.kernel.frame`
    pixels: np.ndarray  # and this the same as colours, uint8 (h, w, 4)


Draw = Callable[[list[Task]], bool]  # False when cancelled


class Auto:
    """A picture in the making: both halves of it, and how many samples the packets have."""

    def __init__(self, draw: Draw, height: int, width: int, across: int) -> None:
        """Of a picture in packets that are `across` wide."""
        self.draw = draw
        self.halves = Replicates(height, width, across)
        self.pixels = np.full((2, height, width, 4), 255, np.uint8)  # of what was last drawn in each half
        self.doublings = np.full(self.halves.packets, -1)  # a packet has 2^doublings samples in each half
        self.shifts = digital_shifts(2, CLASSES, PACKET_HEIGHT * across)
        rows, columns = map(np.arange, self.halves.packets)
        self.classes = np.add.outer(3 * rows, columns) % CLASSES

    def reach(self, error: float, seconds: float) -> Outcome | None:
        """Render until the estimated error is as small or as many seconds have passed, but at least the first round.
        None when cancelled."""
        start = before = perf_counter()
        if not self.begin():
            return None
        contrast, price = self.contrast(), self.price(self.doublings)
        while (squared := self.halves.squared_error) > error**2:
            now = perf_counter()
            left = start + seconds - now
            if left <= 0:
                break
            budget = SPENT * left * price / (now - before) if seconds < inf else inf
            # Half of the way to the goal, as logarithms, since the last steps are the larger the less is known.
            share = min(max(error / sqrt(squared), LEAST_LEFT), MOST_LEFT)
            new = allocate(coefficients(self.halves, self.doublings, contrast), self.doublings, share, budget)
            price, before = self.price(new) - self.price(self.doublings), now
            if not price:
                break
            if not self.grow(new):
                return None
        most, mean = 2 ** (1 + int(self.doublings.max())), 2 * self.price(self.doublings) / self.doublings.size
        return Outcome(mean, most, sqrt(squared), perf_counter() - start)

    def begin(self) -> bool:
        """The first sample of both halves, in all packets. False when cancelled."""
        first = np.zeros_like(self.doublings)
        if not self.draw(self.tasks(first, self.halves.means)):
            return False
        self.halves.compare()
        self.doublings = first
        return True

    def grow(self, new: np.ndarray) -> bool:
        """Add samples until the packets have as many doublings. False when cancelled."""
        if not self.draw(self.tasks(new, self.halves.fresh)):
            return False
        self.halves.add(new > self.doublings, 1 - 2.0 ** (self.doublings - new))
        self.doublings = new
        return True

    def tasks(self, new: np.ndarray, lights: np.ndarray) -> list[Task]:
        """What is missing, for both halves."""
        found: list[Task] = []
        for before, after in sorted({*zip(self.doublings.flat, new.flat, strict=True)}):
            points = sobol(int(2.0**before), 2**after)
            wanted = (self.doublings == before) & (new == after)
            for each in range(CLASSES if before < after else 0):
                packets = (wanted & (self.classes == each)).view(np.uint8)
                places = [shifted(points, shifts[each]) for shifts in self.shifts]
                found += map(Task, places, (packets, packets), lights, self.pixels)
        return found

    def contrast(self) -> np.ndarray:
        """For each packet how many of `CONTRASTS` its pixels and their neighbours differ by in the first half."""
        differs = np.zeros(self.halves.packets, np.int64)
        for least in CONTRASTS:
            differs += np.concatenate(list(edge_packets(self.pixels[0], self.halves.across, least)))
        return differs

    def price(self, doublings: np.ndarray) -> float:
        """The samples of all packets in a half."""
        return float((2.0**doublings).sum())
