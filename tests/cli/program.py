"""The program, as people start it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import NamedTuple

from tests.paths import ROOT
from tests.processes import run, started
from tests.terminals import Terminal
from tests.waiting import HANG_LIMIT

SCENE = """A 0.2 255,255,255
C 0,0,-5 0,0,1 70
L -4,3,-3 0.7 255,255,255
sp 0,0,0 2 10,0,255
pl 0,-1,0 0,1,0 200,200,200
"""
PROGRAM = [sys.executable, "-m", "minirt"]
TELLING = [sys.executable, "-m", "tests.cli.telling"]


class Ended(NamedTuple):
    status: int
    out: bytes
    err: str


def environment() -> dict[str, str]:
    """Without a display, and with this source tree."""
    kept = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    return kept | {"PYTHONPATH": str(ROOT), "PYTHONWARNINGS": "error"}


def start(
    folder: Path, *arguments: str, command: Sequence[str] = PROGRAM, stderr: int = subprocess.PIPE
) -> AbstractContextManager[subprocess.Popen[bytes]]:
    """The program, or another one, running in a folder; it is killed when the block ends."""
    return started([*command, *arguments], cwd=folder, env=environment(), stdout=subprocess.PIPE, stderr=stderr)


def program(folder: Path, *arguments: str) -> Ended:
    """Run the program in a folder to its end."""
    ended = run([*PROGRAM, *arguments], cwd=folder, env=environment())
    return Ended(ended.returncode, ended.stdout, ended.stderr.decode())


def interrupt(process: subprocess.Popen[bytes], told: Terminal) -> tuple[int, bytes]:
    """Send what Ctrl+C in its terminal sends, to the program and to all that it started; its status, and what it has
    written to standard output. What it wrote in the terminal is `told.text`."""
    os.killpg(process.pid, signal.SIGINT)
    told.wait_for_end()
    out, _ = process.communicate(timeout=HANG_LIMIT)
    return process.returncode, out
