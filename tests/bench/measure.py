"""Measure systems in turn: each renders each scene once a round, so that a slow moment of the machine affects all."""

from __future__ import annotations

import os
import sys
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any, NamedTuple

from minirt.rendering.threads import usable_cores

INSTALL = "`make bench-peers` installs it"  # on Debian and Ubuntu


class MissingError(Exception):
    """Raised for a system that cannot be measured here; the text says what is missing."""


class Setting(NamedTuple):
    """Settings that all systems share."""

    width: int
    height: int
    threads: int
    folder: Path  # for files that systems write


class System(ABC):
    """A ray tracer; `MissingError` if it is not installed."""

    name: str
    how: str  # what its time includes

    def __init__(self, setting: Setting) -> None:
        self.setting = setting

    def renders(self, path: Path) -> bool:
        """Whether the system has all that a scene needs."""
        return True

    @abstractmethod
    def frame_times(self, path: Path, seconds: float) -> list[float]:
        """Render frames of a scene file for about `seconds`, at least one; return the milliseconds of each."""

    def picture(self, path: Path) -> Path:
        """Return the path of the scene's picture, for systems that write one."""
        return self.setting.folder / f"{path.stem}-{self.name}.png"


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


MARK = "*"  # marks a figure that other programs disturbed
LACKING = "-"  # for a scene that a system does not render


def figure(ms: float) -> str:
    """Format milliseconds in three significant digits, without an exponent."""
    digits = 2 if ms < 9.995 else 1 if ms < 99.95 else 0
    return f"{ms:.{digits}f}"


def times(ratio: float) -> str:
    """Format a ratio in two significant digits, without an exponent."""
    digits = 2 if ratio < 0.995 else 1 if ratio < 9.95 else 0
    return f"x{ratio:.{digits}f}"


def table(cells: Cells, systems: list[str], scenes: list[str], title: str = "ms a frame") -> str:
    """Return a table with a row per system and a column per scene; ratios are to the first row, which has all."""
    rows = [[title, *scenes]]
    rows += [[system, *(text(cells, system, scene, systems[0]) for scene in scenes)] for system in systems]
    return aligned(rows)


def text(cells: Cells, system: str, scene: str, first: str) -> str:
    """Format a figure, marked if other programs disturbed it, and its ratio to the first system's."""
    if (system, scene) not in cells:
        return LACKING
    cell = cells[system, scene]
    ratio = times(cell.ms / cells[first, scene].ms)
    return f"{figure(cell.ms)}{MARK if cell.disturbed else ' '} {ratio:>5}"


def aligned(rows: list[list[str]]) -> str:
    """Align rows of cells: the first column to the left, the others to the right."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = (
        "  ".join(text.ljust(width) if i == 0 else text.rjust(width) for i, (text, width) in enumerate(cells))
        for cells in (zip(row, widths, strict=True) for row in rows)
    )
    return "\n".join(line.rstrip() for line in lines)


def records(cells: Cells) -> list[dict[str, Any]]:
    """Return the results for a JSON file."""
    return [
        {
            "system": system,
            "scene": scene,
            "ms": round(cell.ms, 3),
            "disturbed": cell.disturbed,
            "rounds": [round(each.ms, 3) for each in cell.rounds],
            "elsewhere": [round(each.elsewhere, 2) for each in cell.rounds],
            "threads": cell.threads,
        }
        for (system, scene), cell in cells.items()
    ]
