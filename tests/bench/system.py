"""What is measured: systems that render the frames of a scene."""

from __future__ import annotations

from abc import ABC, abstractmethod
from pathlib import Path
from typing import NamedTuple

INSTALL = "`make bench-peers` installs it"  # what a comparison needs, on Debian and Ubuntu


class MissingError(Exception):
    """A system that cannot be measured here, and what it lacks."""


class Setting(NamedTuple):
    """What is alike for all systems."""

    width: int
    height: int
    threads: int
    folder: Path  # for what they write


class System(ABC):
    """A ray tracer. `MissingError` where it is not installed."""

    name: str
    how: str  # what its time is

    def __init__(self, setting: Setting) -> None:
        self.setting = setting

    @abstractmethod
    def frame_times(self, path: Path, seconds: float) -> list[float]:
        """Render frames of the scene in a file for about so long, at least one; milliseconds of each."""

    def picture(self, path: Path) -> Path:
        """Where the picture of that scene goes, for systems that write one."""
        return self.setting.folder / f"{path.stem}-{self.name}.png"
