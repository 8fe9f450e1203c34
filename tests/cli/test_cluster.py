"""The program renders by other processes: `--cluster`."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import tifffile

import minirt
from tests.cli.program import Run, environment, program
from tests.processes import is_running, next_line, started
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


def test_a_scheduler_that_cannot_be_reached_is_an_error(run: Run, folder: Path) -> None:
    ended = run("ball.rt", "-o", "a.tif", "--cluster", "nothing://127.0.0.1:1")
    assert (ended.status, ended.out) == (1, b"")
    assert ended.err.startswith("Error\n--cluster nothing://127.0.0.1:1: no scheduler answers: ")


def test_without_dask_an_address_is_an_error(folder: Path) -> None:
    (folder / "distributed.py").write_text("raise ImportError")
    ended = program(folder, "ball.rt", "-o", "a.tif", "--cluster", "tcp://127.0.0.1:1")
    assert (ended.status, "pip install 'minirt[cluster]'" in ended.err) == (1, True)
