"""A report that is interrupted keeps what it has measured, and says what is missing."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from minirt.report.measure import NOTHING
from tests.cli.announcing import RENDERING
from tests.cli.conftest import folder
from tests.cli.program import start
from tests.terminals import Terminal, terminal
from tests.waiting import HANG_LIMIT

__all__ = ["folder"]
ENDLESS = """
import sys
from math import inf
from minirt import cli
from minirt.report import measure
from minirt.report import ablation, measure
from minirt.report.pictures import Budget
from minirt.helpers.system import runs
from tests.cli.announcing import announce_rendering

def endless(work, least, seconds):
    print("fitting", file=sys.stderr, flush=True)
    return runs(work, 10**9, seconds)

announce_rendering()

budget = Budget(0.0, inf, tries=1)
phase, short = sys.argv.pop(1), measure.QUICK._replace(samples=64, seconds=1e30, least_error=inf, budget=budget)
measure.FULL = short
if phase == "fitting":
    measure.runs = endless
elif phase == "the reference":
    measure.FULL = short._replace(samples=2**20, width=1920)
elif phase == "uniform 1":
    measure.FULL = short._replace(budget=Budget(1e9, inf, tries=1))
elif phase == "tiles and their cones without":
    ablation.PAIRS = 10**9
sys.exit(cli.main())
"""
End = Callable[["subprocess.Popen[bytes]"], None]


def ctrl_c(process: subprocess.Popen[bytes]) -> None:
    """Interrupt the program and its children, as a terminal does."""
    os.killpg(process.pid, signal.SIGINT)


def terminate(process: subprocess.Popen[bytes]) -> None:
    """Ask the program to end, as `kill` and a shutdown do."""
    process.terminate()


def interrupted(folder: Path, phase: str, size: str, end: End) -> tuple[int, Terminal]:
    """Interrupt a phase of the work, all of which would take hours; return the exit status and the terminal."""
    arguments = "ball.rt", "--report", "out", "--size", size
    with (
        terminal() as told,
        start(folder, *arguments, command=[sys.executable, "-c", ENDLESS, phase], stderr=told.end) as process,
    ):
        told.leave()
        told.wait_for(phase.encode())
        if phase != "tiles and their cones without":
            told.wait_for(RENDERING)
        assert [*folder.glob("out/*")] == []
        end(process)
        told.wait_for_end()
        out, _ = process.communicate(timeout=HANG_LIMIT)
    assert out == b""
    assert b"Traceback" not in told.text
    return process.returncode, told


@pytest.mark.parametrize("phase", ["fitting", "the reference", "uniform 1"])
def test_before_the_first_figure_there_is_nothing_to_keep(folder: Path, phase: str) -> None:
    status, told = interrupted(folder, phase, "1920x1080", ctrl_c)
    assert status == 130
    assert told.text.replace(RENDERING + b"\r\n", b"").endswith(f"{NOTHING}\r\n".encode())
    assert [*folder.glob("out/*")] == []


@pytest.mark.parametrize(("end", "expected"), [(ctrl_c, 130), (terminate, 128 + signal.SIGTERM)])
def test_what_was_measured_is_written(folder: Path, end: End, expected: int) -> None:
    status, told = interrupted(folder, "tiles and their cones without", "32x20", end)
    assert status == expected
    remark = (
        "Interrupted while measuring tiles and their cones without: this and all that would have followed is missing."
    )
    assert remark.encode() in told.text
    assert b"The report is in out/report.html" in told.text
    out = folder / "out"
    assert remark in (out / "report.html").read_text()
    assert f"**{remark}**" in (out / "report.md").read_text()
    found = json.loads((out / "report.json").read_text())
    assert found["interrupted"] == remark
    assert len(found["pictures"]) > 5
    assert [part["sort"] for part in found["ablation"]] == ["scene"]
    assert {f"error-{row['knob']}-{row['label']}.png".replace(" ", "-") for row in found["pictures"]} <= {
        path.name for path in out.iterdir()
    }
    assert not [*out.glob(".*")]  # of a file that was half written
