"""Automatic sampling: renders until an estimated error is reached or a time has passed.

The first sweep over the picture is a plain frame of one sample a pixel, beside which some packets are probed (see
`minirt.kernel.pixels.squared_error`). Often that is enough. Otherwise the packets are sorted into classes by
their contrast, and are drawn anew with the samples that `minirt.rendering.sampling.packets` chooses for their class.
Where that takes long it is done in portions, random sets of packets, since the probes of each tell how many samples, or
how much time, the next portions need. The picture depends on the error that is asked for alone, or on how fast the
portions were.

Limit: features smaller than a pixel that no sample met may be missing in the picture and in the estimate.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, sqrt
from time import perf_counter

import numpy as np

from minirt.kernel.frame import REFERENCE_SAMPLES
from minirt.rendering.frame import COUNTS, SampleTable, plan_of
from minirt.rendering.outcome import Outcome
from minirt.rendering.sampling.packets import EXPECTED, UNSEEN_ERROR, Packets, allocate, places_of, squared_error

FIRST_PROBES, PROBES = 384, 300  # packets to probe, in the first sweep and in the others
# The mean of the probes of the first sweep is in doubt by its standard error, and by one more probe that might have met
# an edge with such a squared error.
EDGE_ERROR = 0.1
# It ends rendering where it is, with the doubt added, at most the goal; and where the doubt is a greater share of it,
# only where it is, with twice the doubt added, this share of the goal.
VAGUE, FAR_BELOW = 0.4, 0.7
FIRST_PORTION, SECOND_PORTION = 0.125, 0.5  # of the packets; more are drawn only when enough probes are known
CHEAP = 0.5  # samples of a pixel, on average, that are not worth portions
PORTIONS_OF_TIME = 8
DOUBT = 4.0  # factor by which the squared errors of a class may turn out to be greater than the first sweep says
MARGIN = 0.9  # of the squared error that is aimed at
MOST_OF_TIME = 0.25  # of the packets of a portion to probe, or of the time for probes alone, where the time is limited
SHARE_OF_TIME = 0.98  # of the remaining time, to be filled


# Draws the packets of a plan, at positions (k, pixels of a packet, 2), or 6 with places in lens and lights, and writes
# the squared errors of those that are probed; in the first sweep also all packets with the first position. Raises
# `CancelledError`.
Draw = Callable[[np.ndarray, np.ndarray, np.ndarray, bool], object]
Classify = Callable[[], tuple[np.ndarray, np.ndarray]]  # the contrast class of each packet, and the size of each class


class CancelledError(Exception):
    """Rendering was ended early."""


@dataclass(eq=False, repr=False)
class AutoSampler:
    """A picture in the making."""

    draw: Draw
    classify: Classify
    packets: Packets
    numbers: int  # of the picture: three for each pixel
    packet_pixels: int
    with_places: bool = False  # as for `SampleTable`
    speed: float = inf  # samples of packets a second, in the last sweep

    def reach(self, error: float, seconds: float) -> Outcome:
        """Render until the estimated error is at most `error` or `seconds` have passed, at least the first sweep."""
        start = perf_counter()
        goal = error * error * self.numbers  # infinite for a huge error
        self.draw_first()
        packets = self.packets
        mean = packets.errors.mean()
        number = len(packets.errors)
        # References are uncertain where all packets are probed, too; a missed edge is only in one that is not.
        doubt = max(packets.errors.std() / sqrt(number), EDGE_ERROR / number * (1 - number / packets.count))
        total = (mean + doubt / 2) * packets.count + UNSEEN_ERROR
        sure, share = (2.0, FAR_BELOW) if doubt >= VAGUE * mean else (1.0, 1.0)
        if (mean + sure * doubt) * packets.count + UNSEEN_ERROR > share * goal and perf_counter() < start + seconds:
            total = self.refine(goal, start + seconds)
        rms = sqrt(max(total, 0.0) / self.numbers)
        return Outcome(*packets.samples, rms, perf_counter() - start)

    def refine(self, goal: float, end: float) -> float:
        """Draw packets with more samples until the sum of squared errors is at most `goal`, or the time is over;
        return that sum."""
        packets = self.packets
        packets.classify(*self.classify())
        self.probe_classes(end)
        if (total := packets.total()) <= goal:
            return total
        self.draw_in_portions(goal, end)
        turn = -1
        while (total := packets.total()) > goal and (left := end - perf_counter()) > 0 and packets.turn != turn:
            turn = packets.turn
            todo = self.in_need(goal)
            self.draw_some(todo, todo >= 0, goal, left)
        return total

    def probe_classes(self, end: float) -> None:
        """Probe more packets of the classes that have most of the error, if there is time."""
        packets = self.packets
        number = packets.histogram.sum(axis=1)
        c = packets.coefficients()
        part = number * np.maximum(c, EXPECTED * (number @ c) / (number @ EXPECTED))
        known = np.bincount(packets.classes[packets.probes], minlength=len(number))
        more = packets.some_of_each_class(np.maximum(PROBES * part / part.sum() - known, 0))
        most = MOST_OF_TIME * (end - perf_counter()) * self.speed / (1 + 2 * REFERENCE_SAMPLES)
        if 0 < len(more) <= most:
            self.sweep(more, packets.levels[more], more >= 0)

    def draw_in_portions(self, goal: float, end: float) -> None:
        """Draw the packets of all classes that need more samples, in portions."""
        packets = self.packets
        samples = allocate(packets.coefficients(), packets.histogram, MARGIN * goal, inf)
        if end == inf and (packets.histogram * samples)[samples > COUNTS].sum() < CHEAP * packets.count:
            todo = self.with_more(samples)
            self.draw_with(todo, samples, self.to_probe(todo, 1.0))
            return
        todo = self.in_need(goal)
        before, last = 0.0, FIRST_PORTION
        while before < 1:
            chosen = packets.random[todo] < last
            self.draw_some(todo, chosen, goal, (end - perf_counter()) * (last - before) / (1 - before))
            todo, before = todo[~chosen], last
            if end < inf:
                last += 1 / PORTIONS_OF_TIME
            else:
                last = SECOND_PORTION if before < SECOND_PORTION and packets.known < PROBES else 1.0

    def in_need(self, goal: float) -> np.ndarray:
        """The packets of all classes that might need more samples."""
        packets = self.packets
        return self.with_more(allocate(packets.coefficients(), packets.histogram, MARGIN * goal / DOUBT, inf))

    def with_more(self, samples: np.ndarray) -> np.ndarray:
        """The packets of all classes of which some have fewer than these samples (classes, levels)."""
        packets = self.packets
        classes = np.flatnonzero(((samples > COUNTS) & (packets.histogram > 0)).any(axis=1))
        return np.concatenate([np.zeros(0, np.intp), *map(packets.members, classes.tolist())])

    def draw_some(self, todo: np.ndarray, chosen: np.ndarray, goal: float, seconds: float) -> None:
        """Draw the `chosen` of the packets that are still to do, so that in the end all packets of the picture together
        leave the squared error `goal`, or so that it takes those seconds at most."""
        packets = self.packets
        some = todo[chosen]
        if not len(some):
            return
        c, counts = packets.coefficients(), packets.count_some(todo)
        others = squared_error(c, packets.histogram - counts)
        probed = self.to_probe(some, 1.0 if seconds == inf else MOST_OF_TIME)
        cost = 1 + 2 * REFERENCE_SAMPLES * probed.mean()
        budget = SHARE_OF_TIME * seconds * self.speed / cost * len(todo) / len(some) if seconds < inf else inf
        samples = allocate(c, counts, max(MARGIN * goal - others, goal / DOUBT), budget)
        self.draw_with(some, samples, probed, seconds == inf)

    def to_probe(self, some: np.ndarray, most: float) -> np.ndarray:
        """Choose which of some packets to probe, at most that share of them: those that were probed before, and others
        as long as few are known."""
        packets = self.packets
        share = min(max(PROBES - packets.known, 0) / max(len(some), 1), most)
        probed: np.ndarray = packets.dither(some, 2**20) < share
        if packets.known:
            probed |= (packets.levels[some] > 0) & np.isin(some, packets.probes)
        return probed

    def draw_with(self, some: np.ndarray, samples: np.ndarray, probed: np.ndarray, is_urged: bool = True) -> None:
        """Draw those packets that get more samples than they have, by class and level; where that would be none and
        `is_urged`, the numbers are rounded up."""
        packets = self.packets
        levels = packets.levels[some]
        wanted = places_of(samples)[packets.classes[some], levels]
        new = (wanted + packets.dither(some)).astype(np.uint8)
        more = new > levels
        if is_urged and not more.any():
            new = np.ceil(wanted).astype(np.uint8)
            more = new > levels
        if more.any():
            self.sweep(some[more], new[more], probed[more])

    def draw_first(self) -> None:
        """Draw all packets with one sample, and probe some of them."""
        packets = self.packets
        probes = np.flatnonzero(packets.random < FIRST_PROBES / packets.count)
        levels = np.zeros(len(probes), np.uint8)
        table = SampleTable(levels[:1], self.packet_pixels, self.with_places)
        plan = plan_of(probes, packets.columns, table.plan(levels, levels == 0))
        self.carry_out(table.positions, plan, probes, is_first=True)

    def sweep(self, some: np.ndarray, levels: np.ndarray, probed: np.ndarray) -> None:
        """Draw packets with new levels, and probe those that are `probed`."""
        packets = self.packets
        table = SampleTable(np.flatnonzero(np.bincount(levels)), self.packet_pixels, self.with_places)
        plan = plan_of(some, packets.columns, table.plan(levels, probed))
        packets.drawn(some, levels)
        self.carry_out(table.positions, plan, some)

    def carry_out(self, positions: np.ndarray, plan: np.ndarray, some: np.ndarray, is_first: bool = False) -> None:
        """Draw some packets by their plan."""
        start, errors = perf_counter(), np.zeros(len(plan))
        self.draw(positions, plan, errors, is_first)
        probed = plan[:, 4] > 0
        samples = plan[:, 3] @ (1 + 2 * REFERENCE_SAMPLES * probed) + is_first * self.packets.count
        self.speed = float(samples) / max(perf_counter() - start, 1e-9)
        self.packets.probed(some[probed], errors[probed])
