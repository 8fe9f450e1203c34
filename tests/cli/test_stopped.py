"""A program that is stopped goes on when it is continued; one that is killed while it renders leaves nothing behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image, ImageChops

from tests.cli.announcing import RENDERING
from tests.cli.program import ANNOUNCING, program, start
from tests.lines import next_line
from tests.processes import until_stopped
from tests.waiting import HANG_LIMIT

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")

PICTURE = ("ball.rt", "-o", "x.png", "--size", "320x240", "--threads", "2")


def await_rendering(process: subprocess.Popen[bytes]) -> None:
    """Wait until a program has begun to render."""
    assert next_line(process, errors=True) == RENDERING.decode()


def stop_and_continue(process: subprocess.Popen[bytes]) -> bool:
    """Stop a program and its threads, and let it go on; False where it ended before."""
    os.killpg(process.pid, signal.SIGSTOP)
    if stopped := until_stopped(process):
        os.killpg(process.pid, signal.SIGCONT)
    return stopped


def test_a_stopped_program_goes_on(folder: Path) -> None:
    with start(folder, *PICTURE, "--samples", "64", command=ANNOUNCING) as process:
        assert stop_and_continue(process), "it ended at once"
        await_rendering(process)
        if stop_and_continue(process):
            assert process.communicate(timeout=HANG_LIMIT)[1] == b""
            assert process.returncode == 0
    assert program(folder, *PICTURE, "--samples", "64", "-o", "y.png", "--no-metadata").status == 0
    with Image.open(folder / "x.png") as stopped, Image.open(folder / "y.png") as undisturbed:
        assert ImageChops.difference(stopped.convert("RGB"), undisturbed.convert("RGB")).getbbox() is None


def test_a_killed_program_leaves_the_old_picture_and_nothing_else(folder: Path) -> None:
    (folder / "x.png").write_bytes(b"old")
    with start(folder, *PICTURE, "--samples", "65536", command=ANNOUNCING) as process:  # hours
        await_rendering(process)
        process.kill()
        process.wait(HANG_LIMIT)
    assert (folder / "x.png").read_bytes() == b"old"
    assert {path.name for path in folder.iterdir()} == {"ball.rt", "x.png"}
    assert program(folder, *PICTURE).status == 0
    with Image.open(folder / "x.png") as picture:
        assert picture.size == (320, 240)
