"""Taking turns: each system renders each scene once a round, so that whatever slows the machine down slows down all."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import NamedTuple

from minirt.rendering.running.cores import usable_cores
from tests.bench.system import MissingError, System

PROCESSOR_TIME = Path("/proc/stat")  # of all programs, in ticks
QUIET = 0.1  # processors that others may use before a round counts as disturbed


class Clock(NamedTuple):
    """Seconds that have passed, those of all processors that were used, and those that this program used of them."""

    wall: float
    all: float
    own: float


def clock() -> Clock:
    """Where nobody tells what other programs do, they count as idle."""
    own = sum(os.times()[:4])
    try:
        user, nice, system, _, _, *interrupts_and_stolen = map(int, PROCESSOR_TIME.read_text().split()[1:9])
        everyone = (user + nice + system + sum(interrupts_and_stolen)) / os.sysconf("SC_CLK_TCK")
    except (OSError, ValueError):
        everyone = own
    return Clock(perf_counter(), everyone, own)


def elsewhere(start: Clock, end: Clock) -> float:
    """Processors that other programs kept busy, on average."""
    return max(0.0, (end.all - start.all) - (end.own - start.own)) / (end.wall - start.wall)


class Round(NamedTuple):
    """A turn of a system on a scene."""

    ms: float  # of a frame, the median
    elsewhere: float


@dataclass
class Cell:
    """What a system takes for a scene, over all rounds."""

    threads: int
    rounds: list[Round] = field(default_factory=list)

    def quiet(self) -> list[Round]:
        """The rounds in which nobody else needed the processors."""
        spare = usable_cores() - self.threads
        return [each for each in self.rounds if each.elsewhere - max(0, spare) <= QUIET]

    @property
    def disturbed(self) -> bool:
        """Whether no round was quiet."""
        return not self.quiet()

    @property
    def ms(self) -> float:
        """Of a frame: the median of the quiet rounds, or of all where none was quiet."""
        return median(each.ms for each in self.quiet() or self.rounds)


Cells = dict[tuple[str, str], Cell]  # by the names of system and scene


def available(makers: Iterable[Callable[[], System]]) -> tuple[list[System], list[str]]:
    """The systems that can be made here, and why the others cannot."""
    systems, reasons = [], []
    for make in makers:
        try:
            systems.append(make())
        except MissingError as reason:
            reasons.append(str(reason))
    return systems, reasons


def take_turns(systems: list[System], scenes: list[Path], rounds: int, seconds: float) -> Cells:
    """Measure each system on each scene. What no round was quiet for is tried again in as many further rounds."""
    cells: Cells = {}
    for number in range(2 * rounds):
        for scene in scenes:
            for system in systems:
                cell = cells.setdefault((system.name, scene.stem), Cell(system.setting.threads))
                if number < rounds or cell.disturbed:
                    print(f"round {number + 1}: {system.name} on {scene.stem}", file=sys.stderr, flush=True)
                    start = clock()
                    times = system.frame_times(scene, seconds)
                    cell.rounds.append(Round(median(times), elsewhere(start, clock())))
    return cells
