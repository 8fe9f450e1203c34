"""Starts of miniRT's window, on a screen in memory."""

from __future__ import annotations

import subprocess
from functools import cache
from pathlib import Path
from time import perf_counter, sleep

import numpy as np

import minirt
from tests.bench.start import HEIGHT, WIDTH, Start
from tests.bench.system import Setting
from tests.bench.virtual_screen import Pixels, Screen
from tests.processes import started
from tests.waiting import HANG_LIMIT

POLL = 2e-3  # seconds between two looks at the screen
COMPARED = slice(HEIGHT // 4, HEIGHT * 7 // 8)  # rows without the words of the window
WRONG = 1e-3  # share of pixels that may differ by more than 1 of 255


class WindowStart(Start):
    """Starts of miniRT until its window shows the right picture: at full resolution, with one sample per pixel."""

    where = "window"

    def __init__(self, setting: Setting, cold: bool, screen: Screen) -> None:
        super().__init__(setting, cold)
        self.screen = screen

    def start(self, path: Path, environment: dict[str, str]) -> float:
        right = right_picture(path)
        environment = {key: value for key, value in environment.items() if key != "WAYLAND_DISPLAY"}
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        begin = perf_counter()
        options = {"env": environment | {"DISPLAY": self.screen.name}} | quiet
        with started(self.command(path, "--samples", "1"), **options) as program:
            while not shows(self.screen.pixels[:HEIGHT, :WIDTH], right):
                if program.poll() is not None or perf_counter() - begin > HANG_LIMIT:
                    raise RuntimeError(f"{self.name} on {path}: no right picture")
                sleep(POLL)
            took = perf_counter() - begin
        while shows(self.screen.pixels[:HEIGHT, :WIDTH], right):  # until the closed window has left the screen
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
