"""Automatic sampling: renders until an estimated error is reached or a time has passed, with most samples where they
are needed.

The first sweep over the picture takes one sample a pixel, and probes some packets (see `minirt.kernel.frame.
squared_error`). Often that is enough. Otherwise the packets are sorted into classes by their contrast, and are drawn
anew with the samples that `minirt.rendering.sampling.allocation` chooses for their class. This is done in portions,
random sets of packets, since the probes of each tell how many samples, or how much time, the next portions need. Where
an error is asked for, the picture depends on nothing else; where a time is asked for, it depends on how fast the
portions were.

Limit: nothing is known of features that no sample met in any packet of a class. A few features that are smaller than a
pixel may be missing in the picture and in the estimate.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from math import inf, sqrt
from time import perf_counter
from typing import NamedTuple

import numpy as np

from minirt.kernel.frame import PACKET_HEIGHT, REFERENCE_SAMPLES
from minirt.rendering.frame_arguments import GOLDEN_RATIO
from minirt.rendering.sampling.allocation import (
    EXPECTED,
    UNSEEN_ERROR,
    allocate,
    coefficients,
    places_of,
    squared_error,
    unseen,
)
from minirt.rendering.sampling.contrast import CLASSES
from minirt.rendering.sampling.outcome import Outcome
from minirt.rendering.sampling.sample_table import COUNTS, SampleTable, random_numbers

FIRST_PROBES, PROBES = 256, 300  # packets to probe, in the first sweep and in the others
SHARE_PROBED = 1 / 64  # in the first sweep of a large picture
# An estimate that ends rendering after the first sweep, with so many standard errors added, is this share of the goal.
SURE, FAR_BELOW = 2.0, 0.7
# Where the standard error is a greater share of the estimate, so few probes met an edge that one more might have met
# one with such a squared error.
VAGUE, EDGE_ERROR = 0.4, 0.1
FIRST_PORTION, SECOND_PORTION = 0.125, 0.5  # of the packets; more are drawn only when enough probes are known
CHEAP = 0.5  # samples of a pixel, on average, that are not worth portions
PORTIONS_OF_TIME = 8
DOUBT = 4.0  # factor by which the squared errors of a class may turn out to be greater than the first sweep says
MARGIN = 0.9  # of the squared error that is aimed at
MOST_OF_TIME = 0.25  # of the packets of a portion to probe, where the time is limited
SHARE_OF_TIME = 0.98  # of the remaining time, to be filled


class Sweep(NamedTuple):
    """Samples to take in one sweep over the picture."""

    positions: np.ndarray  # (k, pixels of a packet, 2)
    plan: np.ndarray  # as `plan` of `minirt.kernel.frame`
    errors: np.ndarray  # output: squared errors of the probed packets


Draw = Callable[[Sweep], bool]  # False when cancelled
Classify = Callable[[], np.ndarray]


class AutoSampler:
    """A picture in the making: the number of samples of each packet, and the probes that tell their error.

    Packets are counted from 0, row by row. `draw` draws them, `classify` tells their contrast classes (rows, columns).
    """

    def __init__(self, draw: Draw, classify: Classify, height: int, width: int, packet_width: int) -> None:
        self.draw = draw
        self.classify = classify
        self.packet_pixels = PACKET_HEIGHT * packet_width
        self.numbers = 3 * height * width  # of the picture
        self.shape = -(-height // PACKET_HEIGHT), -(-width // packet_width)
        self.count = self.shape[0] * self.shape[1]
        self.random = random_numbers(self.count)
        self.levels, self.classes = np.zeros((2, self.count), np.uint8)
        self.histogram = np.zeros((CLASSES, len(COUNTS)), np.int64)  # of packets, by class and level
        self.is_probed = np.zeros(self.count, bool)  # packets whose error with the samples that they have is known
        self.errors = np.zeros(self.count)  # of those that are probed
        self.sweeps = 0
        self.speed = inf  # samples of packets a second, in the last sweep

    def reach(self, error: float, seconds: float) -> Outcome | None:
        """Render until the estimated error is at most `error` or `seconds` have passed, but at least the first sweep.

        None when cancelled.
        """
        start = perf_counter()
        goal = error * error * self.numbers  # infinite for a huge error
        if not self.draw_first():
            return None
        # A few probes may decide: an estimate that ends rendering is one that is rather too large.
        errors = self.errors[self.is_probed]
        mean, doubt = errors.mean(), errors.std() / sqrt(len(errors))
        if doubt >= VAGUE * mean:
            doubt = max(doubt, EDGE_ERROR / len(errors))
        total: float | None = (mean + doubt) * self.count + UNSEEN_ERROR
        if (mean + SURE * doubt) * self.count + UNSEEN_ERROR > FAR_BELOW * goal and perf_counter() < start + seconds:
            total = self.refine(goal, start + seconds)
        if total is None:
            return None
        counts = COUNTS[self.levels]
        rms = sqrt(max(total, 0.0) / self.numbers)
        return Outcome(float(counts.mean()), int(counts.max()), rms, perf_counter() - start)

    def refine(self, goal: float, end: float) -> float | None:
        """Draw packets with more samples until the sum of squared errors is at most `goal`, or the time is over;
        return that sum, and None when cancelled."""
        self.classes = self.classify().ravel()
        self.histogram = self.count_packets(np.arange(self.count))
        if not self.probe_classes():
            return None
        if (total := self.total()) <= FAR_BELOW * goal:
            return total
        if not self.draw_in_portions(goal, end):
            return None
        while (total := self.total()) > goal and (left := end - perf_counter()) > 0:
            sweeps = self.sweeps
            todo = self.in_need(goal)
            if not self.draw_some(todo, todo >= 0, goal, left):
                return None
            if self.sweeps == sweeps:
                break
        return total

    def probe_classes(self) -> bool:
        """Probe more packets of the classes that have most of the error. False when cancelled."""
        packets = self.histogram.sum(axis=1)
        c = self.coefficients()
        part = packets * np.maximum(c, EXPECTED * (packets @ c) / (packets @ EXPECTED))
        known = np.bincount(self.classes[self.is_probed], minlength=CLASSES)
        share = np.maximum(FIRST_PROBES * part / part.sum() - known, 0) / np.maximum(packets - known, 1)
        more = np.flatnonzero((share > 0)[self.classes] & ~self.is_probed)
        more = more[self.dither(more) < share[self.classes[more]]]
        return self.sweep(more, self.levels[more], more >= 0) if len(more) > FIRST_PROBES / 4 else True

    def draw_in_portions(self, goal: float, end: float) -> bool:
        """Draw the packets of all classes that need more samples, in portions. False when cancelled."""
        todo = self.in_need(goal)
        samples = allocate(self.coefficients(), self.histogram, MARGIN * goal, inf)
        is_cheap = end == inf and (self.histogram * samples)[samples > 1].sum() < CHEAP * self.count
        before, last = 0.0, 1.0 if is_cheap else FIRST_PORTION
        while before < 1:
            chosen = self.random[todo] < last
            if not self.draw_some(todo, chosen, goal, (end - perf_counter()) * (last - before) / (1 - before)):
                return False
            todo, before = todo[~chosen], last
            if end < inf:
                last += 1 / PORTIONS_OF_TIME
            else:
                last = SECOND_PORTION if before < SECOND_PORTION and self.known < PROBES else 1.0
        return True

    def in_need(self, goal: float) -> np.ndarray:
        """The packets of all classes that might need more samples."""
        samples = allocate(self.coefficients(), self.histogram, MARGIN * goal / DOUBT, inf)
        needs = np.count_nonzero((samples > COUNTS) & (self.histogram > 0), axis=1) > 0
        return np.flatnonzero(needs[self.classes])

    def draw_some(self, todo: np.ndarray, chosen: np.ndarray, goal: float, seconds: float) -> bool:
        """Draw the `chosen` of the packets that are still to do, so that in the end all packets of the picture together
        leave the squared error `goal`, or so that it takes those seconds at most. False when cancelled."""
        some = todo[chosen]
        if not len(some):
            return True
        c, packets = self.coefficients(), self.count_packets(todo)
        others = squared_error(c, self.histogram - packets)
        # Packets that are drawn again are probed again, and others as long as few are known.
        share = min(max(PROBES - self.known, 0) / len(some), 1.0 if seconds == inf else MOST_OF_TIME)
        probed: np.ndarray = self.dither(some, 2**20) < share
        probed |= self.is_probed[some] & (self.levels[some] > 0)
        probed[0] |= not np.count_nonzero(self.is_probed)
        cost = 1 + 2 * REFERENCE_SAMPLES * probed.mean()
        budget = SHARE_OF_TIME * seconds * self.speed / cost * len(todo) / len(some) if seconds < inf else inf
        places = places_of(allocate(c, packets, max(MARGIN * goal - others, goal / DOUBT), budget))
        wanted = places[self.classes[some], self.levels[some]]
        new = (wanted + self.dither(some)).astype(np.uint8)
        if seconds == inf and (new <= self.levels[some]).all():
            new = np.ceil(wanted).astype(np.uint8)
        more = new > self.levels[some]
        return self.sweep(some[more], new[more], probed[more]) if more.any() else True

    def draw_first(self) -> bool:
        """Draw all packets with one sample, and probe some of them. False when cancelled."""
        probed, table, plan = first_sweep(self.shape, self.packet_pixels)
        return self.carry_out(Sweep(table.positions, plan, np.zeros(self.shape)), np.flatnonzero(probed))

    def sweep(self, packets: np.ndarray, levels: np.ndarray, probed: np.ndarray) -> bool:
        """Draw packets with new levels, and probe those that are `probed`. False when cancelled."""
        table = SampleTable(np.flatnonzero(np.bincount(levels)), self.packet_pixels)
        plan = np.zeros((self.count, 3), np.int32)
        plan[packets] = table.plan(levels, probed)
        self.histogram -= self.count_packets(packets)
        self.levels[packets] = levels
        self.histogram += self.count_packets(packets)
        self.is_probed[packets] = False
        sweep = Sweep(table.positions, plan.reshape(*self.shape, 3), np.zeros(self.shape))
        return self.carry_out(sweep, packets[probed])

    def carry_out(self, sweep: Sweep, probes: np.ndarray) -> bool:
        """Take samples, and note the errors of the probes. False when cancelled."""
        start = perf_counter()
        if not self.draw(sweep):
            return False
        self.sweeps += 1
        self.is_probed[probes] = True
        self.errors[probes] = sweep.errors.ravel()[probes]
        samples = sweep.plan[..., 1].sum() + 2 * REFERENCE_SAMPLES * COUNTS[self.levels[probes]].sum()
        self.speed = float(samples) / max(perf_counter() - start, 1e-9)
        return True

    @property
    def known(self) -> int:
        """The number of probed packets that have more than one sample."""
        return int(np.count_nonzero(self.is_probed & (self.levels > 0)))

    def dither(self, packets: np.ndarray, salt: int = 2**10) -> np.ndarray:
        """A random number in [0, 1) for each of some packets, another after each sweep."""
        numbers = self.random[packets] * salt + self.sweeps * GOLDEN_RATIO
        dither: np.ndarray = numbers - np.floor(numbers)
        return dither

    def count_packets(self, packets: np.ndarray) -> np.ndarray:
        """Count packets by class and level."""
        slots = self.classes[packets].astype(np.intp) * len(COUNTS) + self.levels[packets]
        counts: np.ndarray = np.bincount(slots, minlength=CLASSES * len(COUNTS)).reshape(CLASSES, -1)
        return counts

    def coefficients(self) -> np.ndarray:
        """Estimate c of every class from all probes."""
        probes = np.flatnonzero(self.is_probed)
        found = coefficients(self.classes[probes], COUNTS[self.levels[probes]], self.errors[probes])
        c: np.ndarray = found + unseen(self.histogram)
        return c

    def total(self) -> float:
        """Estimate the sum of the squared errors of all packets."""
        return squared_error(self.coefficients(), self.histogram)


@lru_cache(2)
def first_sweep(shape: tuple[int, int], packet_pixels: int) -> tuple[np.ndarray, SampleTable, np.ndarray]:
    """The packets to probe in the first sweep, its table of samples and its plan."""
    count = shape[0] * shape[1]
    probed = random_numbers(count) < max(SHARE_PROBED, FIRST_PROBES / count)
    table = SampleTable(np.zeros(1, np.intp), packet_pixels)
    return probed, table, table.plan(np.zeros(count, np.uint8), probed).reshape(*shape, 3)
