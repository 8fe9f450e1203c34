"""Automatic sampling: renders in rounds until an estimated error is reached or a time has passed, with most samples
where they are needed.

The first round has one sample in each half of every pixel, each further round the samples that
`minirt.rendering.sampling.allocation` chooses, until the estimate of `minirt.rendering.sampling.replicates` is good
enough. Where an error is asked for, the picture depends on nothing else; where a time is asked for, it depends on how
fast the rounds were.

Limit: nothing is known of features that no sample met in any packet of a class. A few features that are smaller than a
pixel may be missing in the picture and in the estimate.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf, sqrt
from time import perf_counter

import numpy as np

from minirt.kernel.frame import PACKET_HEIGHT
from minirt.rendering.frame_arguments import SamplePass
from minirt.rendering.sampling.adaptive import edge_packets
from minirt.rendering.sampling.allocation import CONTRASTS, allocate, coefficients
from minirt.rendering.sampling.outcome import Outcome
from minirt.rendering.sampling.replicates import Replicates
from minirt.rendering.sampling.sobol import digital_shifts, shifted, sobol

# Classes of packets, each with its own shifts, so that an edge along a row of pixels meets 8 times as many of them.
SHIFT_CLASSES = 8
LEAST_LEFT, MOST_LEFT = 0.25, 0.8  # share of the squared error that a round may leave
SHARE_OF_TIME = 0.4  # of the remaining time, for a round

Draw = Callable[[list[SamplePass]], bool]  # False when cancelled


class AutoSampler:
    """A picture in the making: its two halves, and the number of samples of each packet."""

    def __init__(self, draw: Draw, height: int, width: int, packet_width: int) -> None:
        self.draw = draw
        self.halves = Replicates(height, width, packet_width)
        self.pixels = np.full((2, height, width, 4), 255, np.uint8)  # of the last pass in each half
        self.doublings = np.full(self.halves.packets, -1)  # a packet has 2^doublings samples in each half
        self.shifts = digital_shifts(2, SHIFT_CLASSES, PACKET_HEIGHT * packet_width)
        rows, columns = map(np.arange, self.halves.packets)
        self.classes = np.add.outer(3 * rows, columns) % SHIFT_CLASSES

    def reach(self, error: float, seconds: float) -> Outcome | None:
        """Render until the estimated error is at most `error` or `seconds` have passed, but at least the first round.

        None when cancelled.
        """
        start = before = perf_counter()
        if not self.first_round():
            return None
        contrast, cost = self.contrast(), self.cost(self.doublings)
        while (squared := self.halves.squared_error) > error * error:  # infinite for a huge error
            now = perf_counter()
            left = start + seconds - now
            if left <= 0:
                break
            budget = SHARE_OF_TIME * left * cost / (now - before) if seconds < inf else inf
            # Go half of the way to the goal on a logarithmic scale: the next round knows more.
            share = min(max(error / sqrt(squared), LEAST_LEFT), MOST_LEFT)
            new = allocate(coefficients(self.halves, self.doublings, contrast), self.doublings, share, budget)
            cost, before = self.cost(new) - self.cost(self.doublings), now
            if not cost:
                break
            if not self.add_samples(new):
                return None
        most, mean = 2 ** (1 + int(self.doublings.max())), 2 * self.cost(self.doublings) / self.doublings.size
        return Outcome(mean, most, sqrt(squared), perf_counter() - start)

    def first_round(self) -> bool:
        """Take the first sample of both halves in all packets. False when cancelled."""
        first = np.zeros_like(self.doublings)
        if not self.draw(self.passes(first, self.halves.means)):
            return False
        self.halves.compare()
        self.doublings = first
        return True

    def add_samples(self, new: np.ndarray) -> bool:
        """Add samples until the packets have the `new` doublings. False when cancelled."""
        if not self.draw(self.passes(new, self.halves.new_means)):
            return False
        self.halves.add(new > self.doublings, 1 - 2.0 ** (self.doublings - new))
        self.doublings = new
        return True

    def passes(self, new: np.ndarray, lights: np.ndarray) -> list[SamplePass]:
        """The missing samples of both halves as passes, which write into `lights` (2, h, w, 3)."""
        passes: list[SamplePass] = []
        for before, after in sorted({*zip(self.doublings.flat, new.flat, strict=True)}):
            points = sobol(int(2.0**before), 2**after)
            grown = (self.doublings == before) & (new == after)
            for each in range(SHIFT_CLASSES if before < after else 0):
                packets = (grown & (self.classes == each)).view(np.uint8)
                positions = [shifted(points, shifts[each]) for shifts in self.shifts]
                passes += map(SamplePass, positions, (packets, packets), lights, self.pixels)
        return passes

    def contrast(self) -> np.ndarray:
        """Count the `CONTRASTS` that the pixels of each packet and their neighbours exceed in the first half."""
        exceeded = np.zeros(self.halves.packets, np.int64)
        for contrast in CONTRASTS:
            exceeded += np.concatenate(list(edge_packets(self.pixels[0], self.halves.packet_width, contrast)))
        return exceeded

    def cost(self, doublings: np.ndarray) -> float:
        """The total number of samples of the packets in a half."""
        return float((2.0**doublings).sum())
