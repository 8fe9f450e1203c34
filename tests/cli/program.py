"""Run the program as a process, as users do."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import NamedTuple, TypeAlias

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
ANNOUNCING = [sys.executable, "-m", "tests.cli.announcing"]


class Result(NamedTuple):
    """Exit status and output of a run."""

    status: int
    out: bytes
    err: str


Run: TypeAlias = Callable[..., Result]  # calls the program in this process with arguments


def environment() -> dict[str, str]:
    """Return the environment of the program: no display, this source tree, warnings as errors."""
    inherited = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    return inherited | {"PYTHONPATH": str(ROOT), "PYTHONWARNINGS": "error"}


def start(
    folder: Path, *arguments: str, command: Sequence[str] = PROGRAM, stderr: int = subprocess.PIPE
) -> AbstractContextManager[subprocess.Popen[bytes]]:
    """Start the program, or another command, in a folder; it is killed when the block ends."""
    return started([*command, *arguments], cwd=folder, env=environment(), stdout=subprocess.PIPE, stderr=stderr)


def program(folder: Path, *arguments: str) -> Result:
    """Run the program in a folder until it ends."""
    ended = run([*PROGRAM, *arguments], cwd=folder, env=environment())
    return Result(ended.returncode, ended.stdout, ended.stderr.decode())


def interrupt(process: subprocess.Popen[bytes], screen: Terminal, number: int = signal.SIGINT) -> tuple[int, bytes]:
    """Send SIGINT, as Ctrl+C does, or another signal to the program and its children; return its exit status and
    standard output. Its standard error, the terminal, is in `screen.text`."""
    os.killpg(process.pid, number)
    screen.wait_for_end()
    out, _ = process.communicate(timeout=HANG_LIMIT)
    return process.returncode, out
