"""The program, as people start it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parent.parent.parent
SCENE = """A 0.2 255,255,255
C 0,0,-5 0,0,1 70
L -4,3,-3 0.7 255,255,255
sp 0,0,0 2 10,0,255
pl 0,-1,0 0,1,0 200,200,200
"""
PROGRAM = [sys.executable, "-m", "minirt"]


class Ended(NamedTuple):
    status: int
    out: bytes
    err: str


def environment() -> dict[str, str]:
    """Without a display, and with this source tree."""
    kept = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    return kept | {"PYTHONPATH": str(ROOT), "PYTHONWARNINGS": "error"}


def start(folder: Path, *arguments: str) -> subprocess.Popen[bytes]:
    """The program, running in a folder."""
    return subprocess.Popen(
        [*PROGRAM, *arguments], cwd=folder, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )


def program(folder: Path, *arguments: str) -> Ended:
    """Run the program in a folder to its end."""
    process = start(folder, *arguments)
    out, err = process.communicate(timeout=60)
    return Ended(process.returncode, out, err.decode())
