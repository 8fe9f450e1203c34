"""Ctrl+Z and `fg` in a shell on a terminal: the program goes on, and the terminal is as it was."""

from __future__ import annotations

import os
import shutil
import sys
import termios
from pathlib import Path

import pytest
from PIL import Image, ImageChops

from tests.cli.program import environment, program
from tests.processes import started
from tests.terminals import terminal

pytestmark = pytest.mark.skipif(not shutil.which("bash"), reason="needs bash, a shell with job control")

PICTURE = ("ball.rt", "-o", "x.png", "--size", "320x240", "--samples", "2")
TAKE_TERMINAL = "import fcntl, os, sys, termios; fcntl.ioctl(0, termios.TIOCSCTTY); os.execvp('bash', sys.argv[1:])"
SHELL = [sys.executable, "-c", TAKE_TERMINAL, "bash", "--norc", "--noprofile", "--noediting", "-i"]
PROMPT = b"ready"


def test_ctrl_z_stops_the_program_and_fg_goes_on(folder: Path) -> None:
    variables = environment() | {"PS1": f"{PROMPT.decode()} ", "TERM": "dumb"}
    with terminal() as screen:
        ends = {"stdin": screen.end, "stdout": screen.end, "stderr": screen.end}
        with started(SHELL, cwd=folder, env=variables, **ends) as shell:
            screen.leave()
            screen.wait_for(PROMPT)
            before = termios.tcgetattr(screen.reader)
            os.write(screen.reader, f"{sys.executable} -m tests.cli.with_bar {' '.join(PICTURE)}\n".encode())
            screen.wait_for(b"left  x.png")
            os.write(screen.reader, b"\x1a")
            screen.wait_for(b"Stopped")
            screen.wait_for(PROMPT)
            assert not (folder / "x.png").exists()
            os.write(screen.reader, b"fg\n")
            screen.wait_for(PROMPT)  # else the terminal shows the next line before it
            os.write(screen.reader, b"echo status $?\n")
            screen.wait_for(b"status 0")
            screen.wait_for(PROMPT)
            assert termios.tcgetattr(screen.reader) == before
            os.write(screen.reader, b"exit\n")
            shell.wait()
    assert b"\r\x1b[K" + PROMPT in screen.text, "the bar was not erased"
    assert program(folder, *PICTURE, "-o", "y.png").status == 0
    assert {path.name for path in folder.iterdir()} == {"ball.rt", "x.png", "y.png"}
    with Image.open(folder / "x.png") as stopped, Image.open(folder / "y.png") as undisturbed:
        assert ImageChops.difference(stopped.convert("RGB"), undisturbed.convert("RGB")).getbbox() is None
