"""Whole reports: files, figures, errors and interrupts."""

from __future__ import annotations

import csv
import hashlib
import json
import os
import signal
import sys
from collections.abc import Callable
from math import inf, isfinite
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import minirt
from minirt.errors import RenderError
from minirt.report import measure
from minirt.report.ablation import Ablation, Part
from minirt.report.measure import NOTHING, QUICK, Measurement, fitting_size, report
from minirt.report.metrics import HEAT
from minirt.report.pictures import Budget
from minirt.report.variants import Variant
from minirt.scene import Scene, dump
from tests.cli.announcing import RENDERING
from tests.cli.conftest import folder, run
from tests.cli.program import Result, start
from tests.kernel.pictures import ALL, AMBIENT, EYE
from tests.simulated_clock import PACKET_SECONDS, Clock, packets, simulate_clock
from tests.terminals import terminal
from tests.waiting import HANG_LIMIT

__all__ = ["folder", "run"]
Run = Callable[..., Result]
ROWS = {"pictures": 9, "orders": 1, "ablation": 3, "single": 1, "certificates": 4}  # at least
TABLES = {f"{table}.csv" for table in ROWS}
DOCUMENTS = {"report.html", "report.md", "report.json", "diagram.svg", "reference.png"}


@pytest.fixture(autouse=True)
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    """Use a plan with little work, and a simulated clock that only rendering moves on."""
    plan = QUICK._replace(samples=64, most=4, least_error=0.01, budget=Budget(0.0, inf, tries=1))
    monkeypatch.setattr(measure, "QUICK", plan)
    return simulate_clock(monkeypatch)


@pytest.fixture
def made(tmp_path: Path) -> Path:
    """Write a report and return its folder."""
    report(ALL, "all.rt", tmp_path / "deep" / "folder", (64, 40), 1, quick=True)
    return tmp_path / "deep" / "folder"


def test_the_files_agree(made: Path) -> None:
    names = {path.name for path in made.iterdir()}
    found = json.loads((made / "report.json").read_text())
    settings = {f"{row['knob']} {row['label']}".replace(" ", "-") for row in found["pictures"]}
    expected = {"uniform": (1, 2, 4), "adaptive": (4,), "auto": (0.01,), "single": (1, 4), "brute-force": (1, 4)}
    assert settings == {f"{knob}-{samples}" for knob, counts in expected.items() for samples in counts}
    assert names == TABLES | DOCUMENTS | {f"error-{name}.png" for name in settings}
    for table, least in ROWS.items():
        read = list(csv.DictReader((made / f"{table}.csv").read_text().splitlines()))
        assert [list(row) for row in read] == [list(row) for row in found[table]]
        assert len(read) == len(found[table]) >= least
        for one, other in zip(read, found[table], strict=True):
            assert all(str(value) == one[key] for key, value in other.items() if value is not None)
    text = (made / "report.md").read_text().replace("**", "")
    for row in found["pictures"]:
        assert f"| {row['knob']} | {row['label']} | {row['samples']:.3g} | {row['rmse']:.5f} |" in text


def test_a_report_can_be_repeated(made: Path) -> None:
    found = json.loads((made / "report.json").read_text())
    about = found["subject"]
    assert (about["scene"], about["width"], about["height"], about["threads"]) == ("all.rt", 64, 40, 1)
    assert about["sha256"] == hashlib.sha256(dump(ALL).encode()).hexdigest()
    assert {"minirt", "python", "numpy", "numba"} <= set(about["versions"])
    assert about["processor"]
    report(ALL, "all.rt", made / "again", (64, 40), 1, quick=True)
    again = json.loads((made / "again" / "report.json").read_text())
    for table, figures in (("pictures", ("rmse", "flip", "changed")), ("certificates", ("hits", "backward_largest"))):
        for figure in figures:
            assert [row[figure] for row in found[table]] == [row[figure] for row in again[table]]


def test_the_text_names_what_was_left_out_and_the_best_settings(made: Path) -> None:
    found, text = json.loads((made / "report.json").read_text()), (made / "report.md").read_text()
    assert "plane 1 hides nothing from light 1" in text
    assert found["same"] == [1, 4]
    assert "testing every ray against every shape gives the same pictures, bit for bit (samples: 1 and 4)" in text
    assert found["reference_samples"] == 64
    assert 0 < found["reference_error"] < min(row["rmse"] for row in found["pictures"])
    assert f"about {found['reference_error']:.1g}" in text
    wanted = next(each for each in found["choices"] if each["wanted"] == "at most 1000 ms")
    least = min(row["rmse"] for row in found["pictures"])
    assert least <= wanted["best"]["rmse"] <= least + found["reference_error"]


def test_error_pictures_show_the_errors(made: Path) -> None:
    one, four = (np.asarray(Image.open(made / f"error-uniform-{samples}.png")).astype(int) for samples in (1, 4))
    assert one.shape == (40, 64, 3)
    assert (one[..., 0] >= HEAT[2, 0]).sum() > (four[..., 0] >= HEAT[2, 0]).sum() > 0  # errors of a hundredth and more
    brute = np.asarray(Image.open(made / "error-brute-force-4.png"))
    assert np.array_equal(brute, four)


def test_a_scene_without_shapes(tmp_path: Path) -> None:
    with pytest.raises(RenderError, match=r"^empty\.rt: a scene without shapes"):
        report(Scene((AMBIENT, EYE)), "empty.rt", tmp_path / "x", (8, 8), 1, quick=True)
    assert not (tmp_path / "x").exists()


def test_a_folder_that_cannot_be_made_is_told_before_the_work(tmp_path: Path, clock: Clock) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(RenderError, match="file/x: cannot be made: Not a directory"):
        report(ALL, "all.rt", tmp_path / "file" / "x", (4096, 4096), 1, quick=False)
    assert clock.packets == 0


def test_a_file_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "report.json").mkdir()
    with pytest.raises(RenderError, match=r"report\.json: cannot write"):
        report(ALL, "all.rt", tmp_path, (16, 16), 1, quick=True)


def test_pictures_are_as_small_as_the_time_asks() -> None:
    once = packets(64, 36) * PACKET_SECONDS
    assert fitting_size(ALL, (64, 36), QUICK) == (64, 36, pytest.approx(once))
    plan = QUICK._replace(width=320)
    seconds = plan.samples * packets(320, 180) * PACKET_SECONDS
    for given, size in (
        (1e9, (320, 180)),
        (1.01 * seconds, (320, 180)),
        (0.99 * seconds, (160, 90)),
        (seconds / 4.01, (80, 45)),
        (seconds / 4**8, (1, 1)),
    ):
        assert fitting_size(ALL, (1280, 720), plan._replace(seconds=given))[:2] == size
    assert fitting_size(ALL, (10_000, 1), QUICK)[:2] == (320, 1)


def test_the_program_writes_a_report(run: Run, folder: Path) -> None:
    ended = run("ball.rt", "--report", "out", "--quick", "--size", "32x20", "--threads", "1")
    assert (ended.status, ended.err) == (0, "")
    assert ended.out.decode().splitlines()[-1] == "The report is in out/report.html"
    assert b"error at most 0.01: " in ended.out
    assert {path.name for path in (folder / "out").iterdir()} >= TABLES | DOCUMENTS
    subject = json.loads((folder / "out" / "report.json").read_text())["subject"]
    assert subject["sha256"] == hashlib.sha256((folder / "ball.rt").read_bytes()).hexdigest()
    assert minirt.load("ball.rt").shapes


def test_the_steps_are_those_that_were_expected(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    came: list[str] = []
    step, seen = Measurement.step, list[Measurement]()

    def noted(self: Measurement, what: str) -> None:
        step(self, what)
        came.append(what)
        seen.append(self)

    monkeypatch.setattr(Measurement, "step", noted)
    report(ALL, "all.rt", tmp_path, (32, 20), 1, quick=True)
    measured = seen[-1]
    assert came[0] == "compiling"
    assert set(came[1:]) == set(measured.seconds)
    assert all(isfinite(seconds) and seconds > 0 for seconds in measured.seconds.values())
    measured.step("the end")
    assert measured.state().share == pytest.approx(1.0)


# An interrupt keeps what was measured, and the report says what is missing.

HELD = """
import sys
from minirt import cli
from minirt.report import measure
from tests.cli.announcing import announce_rendering

announce_rendering()
measure.FULL = measure.QUICK._replace(samples=2**20, width=1920, seconds=1e30)
sys.exit(cli.main())
"""


@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 128 + signal.SIGTERM)])
def test_before_the_first_figure_there_is_nothing_to_keep(folder: Path, number: int, status: int) -> None:
    """A program is interrupted while it renders a reference, which would take hours."""
    arguments = "ball.rt", "--report", "out", "--size", "1920x1080"
    command = [sys.executable, "-c", HELD]
    with terminal() as told, start(folder, *arguments, command=command, stderr=told.end) as process:
        told.leave()
        told.wait_for(b"the reference, 1 of")
        told.wait_for(RENDERING)
        os.killpg(process.pid, number)
        told.wait_for_end()
        out, _ = process.communicate(timeout=HANG_LIMIT)
    assert (process.returncode, out) == (status, b"")
    assert b"Traceback" not in told.text
    assert told.text.replace(RENDERING + b"\r\n", b"").endswith(f"{NOTHING}\r\n".encode())
    assert [*folder.glob("out/*")] == []


def test_what_was_measured_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupted(_: object, variant: Variant) -> Part:
        raise KeyboardInterrupt

    monkeypatch.setattr(Ablation, "part", interrupted)
    with pytest.raises(KeyboardInterrupt):
        report(ALL, "all.rt", tmp_path, (32, 20), 1, quick=True)
    remark = "Interrupted while measuring tiles and their cones without: this and all that would have followed is"
    told = capsys.readouterr().err
    assert remark in told
    assert f"The report is in {tmp_path}/report.html" in told
    assert remark in (tmp_path / "report.html").read_text()
    assert f"**{remark} missing.**" in (tmp_path / "report.md").read_text()
    found = json.loads((tmp_path / "report.json").read_text())
    assert found["interrupted"] == f"{remark} missing."
    assert len(found["pictures"]) > 5
    assert [part["sort"] for part in found["ablation"]] == ["scene"]
    names = {f"error-{row['knob']}-{row['label']}.png".replace(" ", "-") for row in found["pictures"]}
    assert names <= {path.name for path in tmp_path.iterdir()}
    assert not [*tmp_path.glob(".*")]  # of a file that was half written
