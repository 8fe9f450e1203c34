"""Measure systems in turn: each renders each scene once a round, so that a slow moment of the machine affects all."""

from __future__ import annotations

import sys
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from math import floor, log10
from pathlib import Path
from statistics import median
from typing import NamedTuple

MESH, MIRROR, GLASS = "\nob ", "mirror:", "glass:"  # as they stand in a file
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
    lacks: tuple[str, ...] = ()  # what stands in the files of scenes that it cannot render

    def __init__(self, setting: Setting) -> None:
        self.setting = setting

    def renders(self, path: Path) -> bool:
        """Whether the system has all that a scene needs."""
        text = path.read_text(encoding="utf-8")
        return not any(each in text for each in self.lacks)

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


def figure(value: float, digits: int = 3) -> str:
    """Format a positive number in so many significant digits, without an exponent."""
    rounded = float(f"{value:.{digits}g}")
    return f"{rounded:.{max(0, min(2, digits - 1 - floor(log10(rounded))))}f}"


def names(cells: Cells) -> tuple[list[str], list[str]]:
    """Return the systems and the scenes, in the order in which they were measured."""
    return list(dict.fromkeys(system for system, _ in cells)), list(dict.fromkeys(scene for _, scene in cells))


def table(cells: Cells, title: str = "ms a frame") -> str:
    """Return a row per system and a column per scene: medians and their ratios to the first row, which has all."""
    systems, scenes = names(cells)
    first = {scene: median(cells[systems[0], scene]) for scene in scenes}
    lines = [f"{title:<16}" + "".join(f"{scene:>16}" for scene in scenes)]
    for system in systems:
        medians = ((scene, median(cells[system, scene]) if (system, scene) in cells else 0.0) for scene in scenes)
        texts = (f"{figure(ms)} {'x' + figure(ms / first[scene], 2):>5}" if ms else "-" for scene, ms in medians)
        lines.append(f"{system:<16}" + "".join(f"{text:>16}" for text in texts))
    return "\n".join(lines)
