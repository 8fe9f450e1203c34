"""Measure systems in turn: each renders each scene once a round, so that a slow moment of the machine affects all."""

from __future__ import annotations

import sys
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from pathlib import Path
from statistics import median
from typing import NamedTuple

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


Cells = dict[tuple[str, str], list[float]]  # (system, scene) -> milliseconds a frame of each round


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
    """Measure each system on each scene that it renders, once a round."""
    cells: Cells = {}
    for number in range(rounds):
        for scene in scenes:
            for system in (each for each in systems if each.renders(scene)):
                print(f"round {number + 1}: {system.name} on {scene.stem}", file=sys.stderr, flush=True)
                times = system.frame_times(scene, seconds)
                cells.setdefault((system.name, scene.stem), []).append(median(times))
    return cells


LACKING = "-"  # for a scene that a system does not render


def figure(ms: float) -> str:
    """Format milliseconds in three significant digits, without an exponent."""
    digits = 2 if ms < 9.995 else 1 if ms < 99.95 else 0
    return f"{ms:.{digits}f}"


def times(ratio: float) -> str:
    """Format a ratio in two significant digits, without an exponent."""
    digits = 2 if ratio < 0.995 else 1 if ratio < 9.95 else 0
    return f"x{ratio:.{digits}f}"


def names(cells: Cells) -> tuple[list[str], list[str]]:
    """Return the systems and the scenes, in the order in which they were measured."""
    return list(dict.fromkeys(system for system, _ in cells)), list(dict.fromkeys(scene for _, scene in cells))


def table(cells: Cells, title: str = "ms a frame") -> str:
    """Return a table with a row per system and a column per scene; ratios are to the first row, which has all."""
    systems, scenes = names(cells)
    rows = [[title, *scenes]]
    rows += [[system, *(text(cells, system, scene, systems[0]) for scene in scenes)] for system in systems]
    first, *widths = (max(map(len, column)) for column in zip(*rows, strict=True))
    lines = (
        [row[0].ljust(first), *(cell.rjust(width) for cell, width in zip(row[1:], widths, strict=True))] for row in rows
    )
    return "\n".join("  ".join(line).rstrip() for line in lines)


def text(cells: Cells, system: str, scene: str, first: str) -> str:
    """Format the median of all rounds, and its ratio to the first system's."""
    if (system, scene) not in cells:
        return LACKING
    ms = median(cells[system, scene])
    return f"{figure(ms)} {times(ms / median(cells[first, scene])):>5}"
