"""Whole starts: from the start of a program to its picture, in a file or in a window on a screen in memory (Xvfb).

A cold start finds an empty cache of compiled kernels, a warm one the cache of earlier starts.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import cache, partial
from pathlib import Path
from time import perf_counter, sleep
from typing import Any

import numpy as np
from numpy.typing import NDArray

import minirt
from tests.bench.measure import INSTALL, Cells, MissingError, Setting, System, available, take_turns
from tests.bench.peers.programs import Command, PovRay, Tachyon
from tests.processes import run, started
from tests.waiting import HANG_LIMIT
from tests.windows import display, pixels

Pixels = NDArray[np.uint8]  # (height, width, 3), red green blue
QUIET: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}


@contextmanager
def virtual_screen(width: int, height: int) -> Iterator[tuple[str, Pixels]]:
    """Start a screen, which ends with the block; yield its name for DISPLAY, and a view of what it shows.

    `MissingError` if Xvfb is not installed.
    """
    if not shutil.which("Xvfb"):
        raise MissingError(f"windows: Xvfb is not installed; {INSTALL}")
    with tempfile.TemporaryDirectory() as folder, display((width, height), "-fbdir", folder) as (name, _):
        yield name, pixels(np.memmap(Path(folder) / "Xvfb_screen0", np.uint8, "r"))


WIDTH, HEIGHT = 320, 240
Environment = dict[str, str]


class Start(System):
    """Starts of miniRT that write a picture: of the whole program."""

    where = "-o"

    def __init__(self, setting: Setting, cold: bool) -> None:
        super().__init__(setting)
        self.name = f"miniRT {self.where}, {'cold' if cold else 'warm'}"
        self.cold = cold
        self.warmed: set[Path] = set()

    def command(self, path: Path, *options: str) -> list[str]:
        """Return the command that starts miniRT with a scene."""
        size = ["--size", f"{WIDTH}x{HEIGHT}", "--threads", str(self.setting.threads)]
        return [sys.executable, "-m", "minirt", str(path), *size, *options]

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        if self.cold:
            with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
                return [self.start(path, os.environ | {"XDG_CACHE_HOME": folder}) * 1e3]
        environment = os.environ | {"XDG_CACHE_HOME": str((self.setting.folder / "cache").absolute())}
        if path not in self.warmed:
            run_checked(self.command(path, "--bench"), environment)  # which waits for the best kernel
            self.warmed.add(path)
        return [self.start(path, environment) * 1e3]

    def start(self, path: Path, environment: Environment) -> float:
        """Start the program and return the seconds to its picture."""
        return run_checked(self.command(path, "-o", str(self.picture(path))), environment)


class PeerStart(System):
    """Starts of another ray tracer: the whole program, from a scene in its own language."""

    def __init__(self, kind: type[Command], setting: Setting) -> None:
        super().__init__(setting)
        peer = kind(setting)
        self.name = peer.name
        self.prepared = cache(peer.prepared)

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        return [run_checked(self.prepared(path), dict(os.environ)) * 1e3]


def run_checked(command: list[str], environment: Environment) -> float:
    """Run a program, and return the seconds that it took; RuntimeError if it fails."""
    begin = perf_counter()
    ran = run(command, env=environment, text=True)
    if ran.returncode:
        raise RuntimeError(f"{' '.join(command)}: {ran.stderr or ran.stdout}")
    return perf_counter() - begin


POLL = 2e-3  # seconds between two looks at the screen
COMPARED = slice(HEIGHT // 4, HEIGHT * 5 // 8)  # rows without the words of the window
WRONG = 1e-3  # share of pixels that may differ by more than 1 of 255


class WindowStart(Start):
    """Starts of miniRT until its window shows the right picture: at full resolution, with one sample per pixel."""

    where = "window"

    def __init__(self, setting: Setting, cold: bool, screen: tuple[str, Pixels]) -> None:
        super().__init__(setting, cold)
        self.screen, self.pixels = screen

    def start(self, path: Path, environment: Environment) -> float:
        right, window = right_picture(path), self.pixels[:HEIGHT, :WIDTH]
        environment = {key: value for key, value in environment.items() if key != "WAYLAND_DISPLAY"}
        options = {"env": environment | {"DISPLAY": self.screen}} | QUIET
        begin = perf_counter()
        with started(self.command(path, "--samples", "1"), **options) as program:
            while not shows(window, right):
                if program.poll() is not None or perf_counter() - begin > HANG_LIMIT:
                    raise RuntimeError(f"{self.name} on {path}: no right picture")
                sleep(POLL)
            took = perf_counter() - begin
        while shows(window, right):  # until the closed window has left the screen
            sleep(POLL)
        return took


@cache
def right_picture(path: Path) -> Pixels:
    """Return the picture that a window shows of a scene."""
    return minirt.render(minirt.load(path), WIDTH, HEIGHT).array


def shows(window: Pixels, right: Pixels) -> bool:
    """Whether a window shows the right picture, beside its words; not a coarse or an unfinished one."""
    difference = np.abs(window[COMPARED].astype(np.int16) - right[COMPARED])
    return bool((difference.max(axis=-1) > 1).mean() <= WRONG)


def measured(setting: Setting, scenes: list[Path], rounds: int) -> tuple[Cells, list[str]]:
    """Measure starts of miniRT and of the peers that are programs; return why others are left out."""
    folder = setting.folder / "starts"
    folder.mkdir(exist_ok=True)
    small = Setting(WIDTH, HEIGHT, setting.threads, folder)
    with ExitStack() as stack:
        makers: list[Callable[[], System]] = [partial(Start, small, cold) for cold in (False, True)]
        try:
            screen = stack.enter_context(virtual_screen(WIDTH, HEIGHT))
            makers += [partial(WindowStart, small, cold, screen) for cold in (False, True)]
            reasons = []
        except MissingError as reason:
            reasons = [str(reason)]
        makers += [partial(PeerStart, peer, small) for peer in (Tachyon, PovRay)]
        systems, _ = available(makers)  # of peers that are missing, their frames tell
        return take_turns(systems, scenes, rounds, 0.0), reasons
