"""The interface of the systems that the benchmark measures."""

from __future__ import annotations

from abc import ABC, abstractmethod
from pathlib import Path
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
