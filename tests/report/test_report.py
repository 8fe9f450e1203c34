"""Whole reports: files, figures, errors and interrupts."""

from __future__ import annotations

import csv
import hashlib
import json
import os
import signal
import sys
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from math import inf
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from PIL import Image

from minirt import cli
from minirt.errors import RenderError, counted
from minirt.helpers.progress import in_words
from minirt.report import measure
from minirt.report.ablation import PAIRS, Ablation, Part
from minirt.report.crops import SIDE
from minirt.report.measure import CERTIFYING, JUDGING, NOTHING, QUICK, Measurement, report
from minirt.report.metrics import HEAT
from minirt.report.pictures import SettingRenderer
from minirt.report.settings import Setting
from minirt.report.variants import Variant
from minirt.scene import Scene, dump
from tests.cli.announcing import RENDERING
from tests.cli.conftest import folder
from tests.cli.program import start
from tests.kernel.pictures import ALL, AMBIENT, EYE
from tests.simulated_clock import PACKET_SECONDS, PROCESSOR_SHARE, Clock, packets, simulate_clock
from tests.terminals import terminal
from tests.waiting import HANG_LIMIT

__all__ = ["folder"]
ROWS = {"pictures": 7, "orders": 1, "ablation": 4, "certificates": 4}  # at least
TABLES = {f"{table}.csv" for table in ROWS}
DOCUMENTS = {"report.html", "report.md", "report.json", "diagram.svg", "reference.png"}


def plan_little(patch: pytest.MonkeyPatch) -> Clock:
    """Use a plan with little work, and a simulated clock that only rendering moves on."""
    plan = QUICK._replace(samples=64, most=4, least_error=0.01, seconds=0.0, longest=inf, total=inf, pixels=8 * SIDE**2)
    patch.setattr(measure, "QUICK", plan)
    return simulate_clock(patch)


@pytest.fixture(autouse=True)
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    return plan_little(monkeypatch)


class Made(NamedTuple):
    """A report: its folder, its figures, its text, what the program printed and told before, and its steps."""

    folder: Path
    found: dict[str, Any]
    text: str
    printed: str
    told: str
    steps: list[str]
    missing: int


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Made:
    """Let the program write one report, for all tests of reports that are complete."""
    folder, step, steps = tmp_path_factory.mktemp("report"), Measurement.step, list[str]()
    missing_kernels, missing = SettingRenderer.missing_kernels, list[int]()

    def noted(self: Measurement, what: str) -> None:
        step(self, what)
        steps.append(what)

    def counted_kernels(self: SettingRenderer, wanted: list[Setting]) -> int:
        missing.append(missing_kernels(self, wanted))
        return missing[-1]

    (folder / "all.rt").write_text(dump(ALL))
    out, told = StringIO(), StringIO()
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(out), redirect_stderr(told):
        plan_little(patch)
        patch.setattr(Measurement, "step", noted)
        patch.setattr(SettingRenderer, "missing_kernels", counted_kernels)
        patch.chdir(folder)
        assert cli.main(["all.rt", "--report", "deep/folder", "--quick", "--size", "64x40", "--threads", "1"]) == 0
    folder = folder / "deep" / "folder"
    found = json.loads((folder / "report.json").read_text())
    text = (folder / "report.md").read_text()
    return Made(folder, found, text, out.getvalue(), told.getvalue(), steps, *missing)


def test_the_files_agree(made: Made) -> None:
    found, names = made.found, {path.name for path in made.folder.iterdir()}
    settings = {f"{row['knob']} {row['label']}".replace(" ", "-") for row in found["pictures"]}
    expected = {"uniform": (1, 2, 4), "adaptive": (4,), "auto": (0.01,), "single": (1, 4)}
    assert settings == {f"{knob}-{samples}" for knob, counts in expected.items() for samples in counts}
    assert names == TABLES | DOCUMENTS | {f"error-{name}.png" for name in settings}
    for table, least in ROWS.items():
        read = list(csv.DictReader((made.folder / f"{table}.csv").read_text().splitlines()))
        assert [list(row) for row in read] == [list(row) for row in found[table]]
        assert len(read) == len(found[table]) >= least
        for one, other in zip(read, found[table], strict=True):
            assert all(str(value) == one[key] for key, value in other.items() if value is not None)
    for row in found["pictures"]:
        line = f"| {row['knob']} | {row['label']} | {row['samples']:.3g} | {row['rmse']:.5f} |"
        assert line in made.text.replace("**", "")


def test_the_text_names_what_was_measured_what_was_left_out_and_the_best_settings(made: Made) -> None:
    found, about = made.found, made.found["subject"]
    assert (about["scene"], about["width"], about["height"], about["threads"]) == ("all.rt", 64, 40, 1)
    assert about["sha256"] == hashlib.sha256(dump(ALL).encode()).hexdigest()
    assert {"minirt", "python", "numpy", "numba"} <= set(about["versions"])
    assert about["processor"]
    assert "plane 1 hides nothing from light 1" in made.text
    culling = found["ablation"][-1]
    assert (culling["name"], culling["same"]) == ("culling", True)
    assert 0 <= found["single"] < 64 * 40 / 10
    assert found["reference_samples"] == 64
    assert 0 < found["reference_error"] < min(row["rmse"] for row in found["pictures"])
    assert f"about {found['reference_error']:.1g}" in " ".join(made.text.split())
    choice = next(each for each in found["choices"] if each["goal"] == "0.03")
    assert choice["best"]["rmse_high"] <= 0.03


def test_the_program_prints_the_answers_and_where_the_report_is(made: Made) -> None:
    *answers, last = made.printed.splitlines()
    assert last == "The report is in deep/folder/report.html"
    starts = "Best setting: ", "Exactness: ", "Left out: ", "Does --samples auto pay here? "
    for told, begin in zip(answers, starts, strict=False):
        assert told.startswith(begin)
        assert f"- **{begin.strip()}**" in made.text.replace("`", "")
    begins = "Measuring all.rt at 64x40 pixels with 1 thread: about 3 s where nothing else runs"
    compiling = f", and up to {in_words(15 * made.missing)} to compile {counted(made.missing, 'kernel')}"
    assert made.told == f"{begins}{compiling if made.missing else ''}\n"


def test_error_pictures_show_the_errors(made: Made) -> None:
    one, four = (
        np.asarray(Image.open(made.folder / f"error-{name}.png")).astype(int) for name in ("uniform-1", "uniform-4")
    )
    assert one.shape == (40, 64, 3)
    assert (one[..., 0] >= HEAT[2, 0]).sum() > (four[..., 0] >= HEAT[2, 0]).sum() > 0  # errors of a hundredth and more


def test_the_steps_are_told_and_the_share_is_that_of_the_expected_time(made: Made) -> None:
    halves = ["the reference, half 1 of 2", "the reference, half 2 of 2"]
    assert [*made.steps[:3], *made.steps[-5:-3]] == [*halves, "uniform 1", "run times", "certificates of hits"]
    measured = Measurement(ALL, "all.rt", (64, 40), QUICK, 1)
    assert measured.state().share == 0.0  # nobody knows so far
    once = packets(64, 40) * PACKET_SECONDS * PROCESSOR_SHARE
    measured.announcement()
    works = [once * setting.knob.work(setting.value) for setting in measured.wanted]
    parts = sum(2 * PAIRS * once for _ in measured.variants)
    judged = JUDGING * 64 * 40 * len(works)
    expected = once * QUICK.samples + sum(works) + judged + QUICK.seconds + CERTIFYING + parts
    assert measured.seconds == pytest.approx(expected)
    measured.start -= measured.seconds / 2
    assert 0.5 <= (measured.state().share or 0.0) < 0.9
    measured.start -= 10 * measured.seconds
    assert (measured.state().share or 0.0) < 1.0  # it takes longer than expected


def test_kernels_that_are_missing_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    measured = Measurement(ALL, "all.rt", (64, 40), QUICK, 1)
    monkeypatch.setattr(SettingRenderer, "missing_kernels", lambda *_: 2)
    assert measured.announcement().endswith(" where nothing else runs, and up to 30 s to compile 2 kernels")


def test_errors_are_those_of_the_size_that_was_asked_for(tmp_path: Path) -> None:
    """In crops of it, and the first sentence says so. Two reports measure the same errors and recommend the same."""
    how: dict[str, Any] = {"size": (320, 200), "threads": 1, "quick": True}
    first = report(ALL, "all.rt", tmp_path / "one", **how)
    second = report(ALL, "all.rt", tmp_path / "two", **how, against=tmp_path / "one" / "report.json")
    assert "miniRT all.rt -o picture.png --size 320x200 --samples" in first.splitlines()[0]
    assert first.splitlines()[0] == second.splitlines()[0]
    one, two = (json.loads((tmp_path / name / "report.json").read_text()) for name in ("one", "two"))
    assert [row["rmse"] for row in one["pictures"]] == [row["rmse"] for row in two["pictures"]]
    assert (one["subject"]["width"], one["subject"]["height"], one["subject"]["pixels"]) == (320, 200, 8 * SIDE**2)
    assert f"What changed? of {len(one['pictures'])} settings, beyond the intervals," in second
    assert "; 0 closer, 0 further off." in second


def test_a_scene_without_shapes(tmp_path: Path) -> None:
    with pytest.raises(RenderError, match=r"^empty\.rt: a scene without shapes"):
        report(Scene((AMBIENT, EYE)), "empty.rt", tmp_path / "x", (8, 8), 1, quick=True)
    assert not (tmp_path / "x").exists()


def test_a_folder_that_cannot_be_made_is_told_before_the_work(tmp_path: Path, clock: Clock) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(RenderError, match="file/x: cannot be made: Not a directory"):
        report(ALL, "all.rt", tmp_path / "file" / "x", (4096, 4096), 1, quick=False)
    assert clock.packets == 0


# An interrupt keeps what was measured, and the report says what is missing.

HELD = """
import sys
from minirt import cli
from minirt.report import measure
from tests.cli.announcing import announce_rendering

announce_rendering()
measure.FULL = measure.QUICK._replace(samples=2**20, pixels=2**30)
sys.exit(cli.main())
"""


def test_before_the_first_figure_there_is_nothing_to_keep(folder: Path) -> None:
    """A program is interrupted while it renders a reference, which would take hours."""
    arguments = "ball.rt", "--report", "out", "--size", "1920x1080"
    command = [sys.executable, "-c", HELD]
    with terminal() as told, start(folder, *arguments, command=command, stderr=told.end) as process:
        told.leave()
        told.wait_for(b"the reference, ")
        told.wait_for(RENDERING)
        os.killpg(process.pid, signal.SIGINT)
        told.wait_for_end()
        out, _ = process.communicate(timeout=HANG_LIMIT)
    assert (process.returncode, out) == (130, b"")
    assert b"Traceback" not in told.text
    assert told.text.replace(RENDERING + b"\r\n", b"").endswith(f"{NOTHING}\r\n".encode())
    assert [*folder.glob("out/*")] == []


def test_what_was_measured_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(_: object, variant: Variant) -> Part:
        raise KeyboardInterrupt

    monkeypatch.setattr(Ablation, "part", interrupted)
    with pytest.raises(KeyboardInterrupt) as interrupt:
        report(ALL, "all.rt", tmp_path, (32, 20), 1, quick=True)
    remark = "Interrupted while measuring tiles and their cones without: this and all that would have followed is"
    (told,) = interrupt.value.__notes__
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


def test_a_slow_scene_gets_less_work(monkeypatch: pytest.MonkeyPatch) -> None:
    """Dear settings are left out, until all fits or hardly anything has more than one run."""
    monkeypatch.setattr(measure, "QUICK", QUICK)
    found = []
    for once in (0.001, 0.1, 0.3, 30.0):
        measured = Measurement(ALL, "all.rt", (1280, 720), QUICK, 1)
        monkeypatch.setattr(measured.stage, "frame_seconds", lambda once=once: once)
        measured.announcement()
        found.append((measured.stage.longest, measured.seconds))
        assert measured.seconds <= QUICK.total or measured.stage.longest <= 2 * once
    assert found[0][0] == found[-1][0] == QUICK.longest
    assert found[0][1] < found[1][1] <= QUICK.total
