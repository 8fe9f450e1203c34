"""Automatic sampling: renders until an estimated error is reached or a time has passed.

At first some packets are probed (see `minirt.kernel.pixels.squared_error`), and the first sweep over the picture is a
plain frame of one sample a pixel. Often that is enough. Otherwise `minirt.rendering.sampling.packets` plans numbers of
samples by contrast. Where they are far from those of the probes, a pilot of few packets gets them and is probed, too.
Its error corrects the plan, and all other packets are drawn: in portions where a time is given, since each tells how
fast the next one is.

What an estimate may be wrong by is added before it is compared with the goal, and its standard error before it is
told. Probes take a fifth of the time at most, and no pixel takes more than `MOST_SAMPLES`. The picture depends on the
error that is asked for alone, or on how fast the portions were.

Limit: features smaller than a pixel that no sample met may be missing in the picture and in the estimate.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import inf, sqrt
from time import perf_counter

import numpy as np

from minirt.rendering.frame import ALL_PACKETS, DRAWN, NO_ERRORS, SampleTable, plan_of
from minirt.rendering.outcome import Outcome
from minirt.rendering.sampling.packets import Packets, cost

PROBES = 0.2  # share of samples that probes take, at most
REFERENCES = 2  # samples of a probe beside those that are drawn, as a multiple of them
FAR = 2.0  # ratio of planned samples to those of the last probes from which on there is another pilot
PILOTS = 4  # at most
PORTIONS = 8  # of the packets, where the time is limited
SHARE_OF_TIME = 0.98  # of the remaining time, to be filled


# Draws the packets of a plan, or all without one, at positions (k, pixels of a packet, 2), or 6 with places in lens and
# lights, and writes the squared errors of those that are probed. Raises `CancelledError`.
Draw = Callable[[np.ndarray, np.ndarray, np.ndarray], object]


class CancelledError(Exception):
    """Rendering was ended early."""


@dataclass(eq=False, repr=False)
class AutoSampler:
    """A picture in the making."""

    draw: Draw
    classify: Callable[[], np.ndarray]  # contrast classes of packets (rows, columns)
    packets: Packets
    numbers: int  # of the picture: three for each pixel
    packet_pixels: int
    with_places: bool = False  # as for `SampleTable`
    positions: np.ndarray = field(init=False)  # of the samples of the last sweep
    speed: float = inf  # samples of packets a second, in the last sweep
    probed: float = 0.0  # samples of packets that probes took

    def reach(self, error: float, seconds: float) -> Outcome:
        """Render until the estimated error is at most `error` or `seconds` have passed, at least the first sweep."""
        start = perf_counter()
        goal = error * error * self.numbers  # infinite for a huge error
        packets = self.packets
        probes = packets.choose(PROBES / (1 + REFERENCES) * packets.count)
        errors = self.sweep(probes, np.zeros(len(probes), np.uint8), is_probed=True)
        self.carry_out(self.positions[:1], ALL_PACKETS, NO_ERRORS, packets.count)
        packets.learn(self.classify(), probes, errors)
        if (samples := packets.plan(goal)).max() > 1 and perf_counter() < start + seconds:
            self.refine(samples, goal, start + seconds)
        mean, most, total = packets.outcome()
        return Outcome(mean, most, sqrt(total / self.numbers), perf_counter() - start)

    def refine(self, samples: np.ndarray, goal: float, end: float) -> None:
        """Draw packets with more samples until the sum of squared errors is at most `goal`, or until the time `end` of
        `perf_counter`, which may be infinite.

        `samples` (classes,) are the numbers that were planned after the first probes. Pilots correct them.
        """
        packets = self.packets
        # Samples of the last probes: one. Where samples have places in a lens or in lights, there is always a pilot.
        probed_with = np.full(len(samples), 0.0 if self.with_places else 1.0)
        for _ in range(PILOTS):
            if (samples <= FAR * probed_with).all():
                break
            probed_with = packets.plan(goal, self.budget(end)) if end < inf else samples
            self.draw_pilot(probed_with)
            samples = packets.plan(goal, self.budget(end))
        if end == inf:
            self.draw_more(np.arange(packets.count), samples)
            return
        is_enough, order = packets.bound(samples) <= goal, packets.random.argsort()
        for number in range(PORTIONS):
            some, budget = order[number::PORTIONS], self.budget(end) / (PORTIONS - number)
            expected = float(cost(samples, np.bincount(packets.classes[some], minlength=len(samples))))
            factor = max(budget, 0.0) / max(expected, 1.0)
            if is_enough:  # no more than planned; else all that the time pays for
                factor = min(factor, 1.0)
            self.draw_more(some, np.maximum(samples * factor, 1.0))

    def budget(self, end: float) -> float:
        """The samples of packets that the time pays for."""
        return SHARE_OF_TIME * (end - perf_counter()) * self.speed if end < inf else inf

    def draw_pilot(self, samples: np.ndarray) -> None:
        """Draw and probe some packets with as many samples as those of their class are to have."""
        packets = self.packets
        chances = packets.chances(samples)
        wanted = packets.count + cost(samples, packets.sizes)
        each = REFERENCES * float(packets.sizes * chances @ samples)
        pilot = packets.choose(float(PROBES * wanted - self.probed) / each, chances)
        packets.correct(samples, pilot, self.sweep(pilot, packets.wanted(samples)[pilot], is_probed=True))

    def draw_more(self, some: np.ndarray, samples: np.ndarray) -> None:
        """Draw those of some packets that have fewer samples than they are to have by their class."""
        levels = self.packets.wanted(samples)[some]
        more = levels > self.packets.levels[some]
        self.sweep(some[more], levels[more])

    def sweep(self, some: np.ndarray, levels: np.ndarray, is_probed: bool = False) -> np.ndarray:
        """Draw some packets with new levels; return their squared errors if they are probed, too."""
        packets, errors = self.packets, np.zeros(len(some))
        if not len(some):
            return errors
        table = SampleTable(levels, self.packet_pixels, self.with_places, with_references=is_probed)
        plan = plan_of(some, packets.columns, table.plan(levels))
        packets.levels[some], self.positions = levels, table.positions
        drawn, references = float(plan[:, DRAWN].sum()), REFERENCES if is_probed else 0
        self.probed += drawn * references
        self.carry_out(table.positions, plan, errors, drawn * (1 + references))
        return errors

    def carry_out(self, positions: np.ndarray, plan: np.ndarray, errors: np.ndarray, samples: float) -> None:
        """Draw by a plan, and note how many samples of packets that is a second."""
        start = perf_counter()
        self.draw(positions, plan, errors)
        self.speed = samples / max(perf_counter() - start, 1e-9)
