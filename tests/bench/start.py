"""Whole starts: from the start of a program to its picture, in a file or in a window.

A cold start finds an empty cache of compiled kernels, a warm one the cache of earlier starts.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from time import perf_counter

from tests.bench.peers.command import Command
from tests.bench.system import Setting, System
from tests.processes import run

WIDTH, HEIGHT = 320, 240


class Start(System):
    """Starts of miniRT."""

    where: str

    def __init__(self, setting: Setting, cold: bool) -> None:
        super().__init__(setting)
        self.name = f"miniRT {self.where}, {'cold' if cold else 'warm'}"
        self.how = "the whole program" + (" with an empty cache of kernels" if cold else "")
        self.cold = cold
        self.warmed: set[Path] = set()

    def command(self, path: Path, *options: str) -> list[str]:
        """Return the command that starts miniRT with a scene."""
        size = ["--size", f"{WIDTH}x{HEIGHT}", "--threads", str(self.setting.threads)]
        return [sys.executable, "-m", "minirt", str(path), *size, *options]

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        with self.cache_folder() as folder:
            environment = os.environ | {"XDG_CACHE_HOME": str(folder)}
            if not self.cold and path not in self.warmed:
                run_checked(self.command(path, "--bench"), environment)  # which waits for the best kernel
                self.warmed.add(path)
            return [self.start(path, environment) * 1e3]

    @contextmanager
    def cache_folder(self) -> Iterator[Path]:
        """Yield the cache folder of a start: an empty one, or one for all warm starts."""
        if self.cold:
            with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
                yield Path(folder)
        else:
            yield (self.setting.folder / "cache").absolute()

    def start(self, path: Path, environment: dict[str, str]) -> float:
        """Start the program and return the seconds to its picture."""
        raise NotImplementedError


class FileStart(Start):
    """Starts of miniRT that write a picture."""

    where = "-o"

    def start(self, path: Path, environment: dict[str, str]) -> float:
        command = self.command(path, "-o", str(self.picture(path)))
        begin = perf_counter()
        run_checked(command, environment)
        return perf_counter() - begin


class PeerStart(System):
    """Starts of another ray tracer: the whole program, from a scene in its own language."""

    how = "the whole program"

    def __init__(self, kind: type[Command], setting: Setting) -> None:
        super().__init__(setting)
        peer = kind(setting)
        self.name = peer.name
        self.prepared = cache(peer.prepared)

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        command = self.prepared(path)
        begin = perf_counter()
        run_checked(command, dict(os.environ))
        return [(perf_counter() - begin) * 1e3]


def run_checked(command: list[str], environment: dict[str, str]) -> None:
    """Run a program; RuntimeError if it fails."""
    ran = run(command, env=environment, text=True)
    if ran.returncode:
        raise RuntimeError(f"{' '.join(command)}: {ran.stderr or ran.stdout}")
