"""The program renders by other processes: `--cluster`."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import tifffile

import minirt
from tests.cli.program import Run, environment, interrupt, program, start
from tests.processes import is_running, next_line, started
from tests.terminals import terminal
from tests.waiting import until

LOCAL = ("--cluster", "local")


def test_files_are_those_of_one_process(run: Run, folder: Path) -> None:
    """Bands of a picture, frames of a film and numbered pictures, byte by byte, with what they carry."""
    for name, *arguments in (
        ("a.png", "--size", "600x300", "--samples", "2", "--dither"),
        ("a.gif", "--turntable", "6", "--size", "60x30"),
        ("a.exr", "--turntable", "5", "--frames", "2-4", "--size", "60x30", "--region", "3,5,40,20"),
    ):
        written = []
        for more in ((), LOCAL):
            assert run("ball.rt", "-o", name, *arguments, *more) == (0, b"", "")
            files = sorted(folder.glob("a*"))
            written.append([(each.name, each.read_bytes()) for each in files])
            for each in files:
                each.unlink()
        assert written[0] == written[1]


POOL = """
import os, sys
from minirt.cluster.executor import local_pool
workers = local_pool()
list(workers.map(os.getpgid, [0] * 8))
print(*workers._processes, flush=True)
sys.stdin.read()
"""


@pytest.mark.skipif(sys.platform != "linux", reason="is_running reads /proc")
def test_the_processes_of_a_killed_program_end(tmp_path: Path) -> None:
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with started([sys.executable, "-c", POOL], cwd=tmp_path, env=environment(), text=True, **pipes) as process:
        workers = list(map(int, next_line(process).split()))
        assert workers
        assert all(map(is_running, workers))
        process.kill()
        until(lambda: not any(map(is_running, workers)), "the end of the processes")


def test_sizes_may_exceed_those_of_one_process(run: Run, folder: Path) -> None:
    assert run("ball.rt", "--size", "16400x17", "--bits", "16", "-o", "a.tif", *LOCAL) == (0, b"", "")
    picture = minirt.render(minirt.load("ball.rt"), 16400, 17)
    assert np.array_equal(tifffile.imread("a.tif"), picture.deep)
    ended = run("ball.rt", "--size", "16400x17", "-o", "a.tif")
    assert (ended.status, "argument --size: must be a whole number from 1 to 16384" in ended.err) == (2, True)


@pytest.mark.parametrize("output", ["a.tif", "a.gif"])
def test_an_error_is_reached_and_told(run: Run, folder: Path, output: str) -> None:
    film = ("--turntable", "2") if output == "a.gif" else ()
    goal = "--size", "320x180", "--samples", "auto", "--strict", "--error"
    ended = run("ball.rt", "-o", output, *film, *goal, "0.01", *LOCAL)
    assert ended.status == 0
    found = re.search(r"estimated error ([\d.]+)", ended.err)
    assert found
    assert float(found[1]) <= 0.01
    if output == "a.tif":  # 8 bits end before
        ended = run("ball.rt", "-o", output, *goal, "0.000001", *LOCAL)
        assert (ended.status, "notice: no more samples" in ended.err) == (1, True)


@pytest.mark.parametrize("number", [signal.SIGINT, *([signal.SIGHUP] if hasattr(signal, "SIGHUP") else [])])
def test_an_interrupted_picture_keeps_its_bands_and_ends_all_processes(folder: Path, number: int) -> None:
    how = "--size", "640x1600", "--samples", "16384", "--threads", "1", "-o", "a.tif"
    with terminal() as screen, start(folder, "ball.rt", *how, *LOCAL, stderr=screen.end) as running:
        screen.leave()
        until(lambda: bool(re.search(rb"([4-9]|1\d) of 64 bands", screen.read())) or running.poll() is not None, "work")
        assert running.poll() is None, "the work ended before it could be interrupted"
        assert (
            interrupt(running, screen, number)[0] == 128 + number
        )  # after the end of all processes, which have the terminal open
    assert b"Traceback" not in screen.text
    assert re.search(
        rb"\d+ of 64 bands of the picture \w+ kept in .a.tif.journal; the same command or call goes on", screen.text
    )
    assert {each.name for each in folder.iterdir()} == {"ball.rt", ".a.tif.journal"}


def test_a_scheduler_that_cannot_be_reached_is_an_error(run: Run, folder: Path) -> None:
    ended = run("ball.rt", "-o", "a.tif", "--cluster", "nothing://127.0.0.1:1")
    assert (ended.status, ended.out) == (1, b"")
    assert ended.err.startswith("Error\n--cluster nothing://127.0.0.1:1: no scheduler answers: ")


def test_without_dask_an_address_is_an_error(folder: Path) -> None:
    (folder / "distributed.py").write_text("raise ImportError")
    ended = program(folder, "ball.rt", "-o", "a.tif", "--cluster", "tcp://127.0.0.1:1")
    assert (ended.status, "pip install 'minirt[cluster]'" in ended.err) == (1, True)
