"""Measure systems in turn: each renders each scene once a round, so that a slow moment of the machine affects all."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import NamedTuple

from minirt.rendering.threads import usable_cores
from tests.bench.system import MissingError, System

PROCESSOR_TIME = Path("/proc/stat")  # processor time of all programs, in ticks
QUIET = 0.1  # processors that others may use before a round counts as disturbed


class Clock(NamedTuple):
    """Wall time, processor time of all programs and of this one, in seconds."""

    wall: float
    all: float
    own: float


def clock() -> Clock:
    """Read the clock; where the system does not tell about other programs, they count as idle."""
    own = sum(os.times()[:4])
    try:
        user, nice, system, _, _, *interrupts_and_stolen = map(int, PROCESSOR_TIME.read_text().split()[1:9])
        everyone = (user + nice + system + sum(interrupts_and_stolen)) / os.sysconf("SC_CLK_TCK")
    except (OSError, ValueError):
        everyone = own
    return Clock(perf_counter(), everyone, own)


def elsewhere(start: Clock, end: Clock) -> float:
    """Return how many processors other programs kept busy, on average."""
    return max(0.0, (end.all - start.all) - (end.own - start.own)) / (end.wall - start.wall)


class Round(NamedTuple):
    """One turn of a system on a scene."""

    ms: float  # milliseconds per frame, the median
    elsewhere: float


@dataclass
class Cell:
    """All rounds of a system on a scene."""

    threads: int
    rounds: list[Round] = field(default_factory=list)

    def quiet(self) -> list[Round]:
        """The rounds in which no other program needed the processors."""
        spare = usable_cores() - self.threads
        return [each for each in self.rounds if each.elsewhere - max(0, spare) <= QUIET]

    @property
    def disturbed(self) -> bool:
        """Whether all rounds were disturbed."""
        return not self.quiet()

    @property
    def ms(self) -> float:
        """Milliseconds per frame: the median of the quiet rounds, or of all rounds if none was quiet."""
        return median(each.ms for each in self.quiet() or self.rounds)


Cells = dict[tuple[str, str], Cell]  # (system, scene) -> cell


def available(makers: Iterable[Callable[[], System]]) -> tuple[list[System], list[str]]:
    """Return the systems that are installed, and for each other system the reason why it cannot be measured."""
    systems, reasons = [], []
    for make in makers:
        try:
            systems.append(make())
        except MissingError as reason:
            reasons.append(str(reason))
    return systems, reasons


def take_turns(systems: list[System], scenes: list[Path], rounds: int, seconds: float) -> Cells:
    """Measure each system on each scene that it renders; cells without a quiet round get as many further rounds."""
    cells: Cells = {}
    for number in range(2 * rounds):
        for scene in scenes:
            for system in (each for each in systems if each.renders(scene)):
                cell = cells.setdefault((system.name, scene.stem), Cell(system.setting.threads))
                if number < rounds or cell.disturbed:
                    print(f"round {number + 1}: {system.name} on {scene.stem}", file=sys.stderr, flush=True)
                    start = clock()
                    times = system.frame_times(scene, seconds)
                    cell.rounds.append(Round(median(times), elsewhere(start, clock())))
    return cells
