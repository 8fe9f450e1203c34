"""`--bench` measures frames that keep the lists of the last one and frames that do not; POV-Ray draws our scenes."""

from __future__ import annotations

import shutil
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from minirt import load
from minirt.errors import RenderError
from minirt.materials import Checker, Specular
from minirt.rendering import Renderer
from minirt.rendering.packing.visibility import Bins
from minirt.report import bench, povray
from minirt.report.bench import Run, is_disturbed, runs
from minirt.report.pictures import Budget, reference
from minirt.report.povray import SETTINGS, PovRay, translated
from minirt.scene import Background, FurtherLight, ParallelLight, Scene
from tests.kernel.pictures import ALL, AMBIENT, EYE, LAMP, MORE, SHAPES
from tests.paths import ROOT

PATH = ROOT / "scenes" / "demo.rt"
SIZE = (16, 9)


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Log each frame and, before it, the making of the lists that it needs."""
    log: list[str] = []

    lists, render = Bins.see_from, Renderer.render

    def logged_lists(*arguments: Any) -> Any:
        log.append("lists")
        return lists(*arguments)

    def logged_render(renderer: Renderer, scene: Scene, pixels: np.ndarray) -> None:
        render(renderer, scene, pixels)
        if pixels.shape[:2] == SIZE[::-1]:  # not the pixel for which the kernel is prepared
            log.append("frame")

    monkeypatch.setattr(Bins, "see_from", logged_lists)
    monkeypatch.setattr(Renderer, "render", logged_render)
    monkeypatch.setattr(bench, "LEAST_SECONDS", 0.0)
    return log


def test_an_eye_at_rest_keeps_the_lists_and_a_moving_one_needs_new_ones_for_each_frame(made: list[str]) -> None:
    bench.measure(str(PATH), load(PATH), SIZE, 1, "double")
    rest, *moving = (len([*group]) for entry, group in groupby(made) if entry == "frame")
    assert rest == 1 + bench.LEAST_FRAMES  # the first one is not counted
    assert moving == [1] * (1 + bench.LEAST_FRAMES)
    assert bench.moved(load(PATH)).camera.position == pytest.approx(np.add(load(PATH).camera.position, (1e-3, 0, 0)))


def test_runs_have_both_times_and_fill_the_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """On a simulated machine, whose clocks advance by its work alone."""
    clocks = {"perf_counter": 100.0, "process_time": 7.0}

    def work() -> None:
        clocks["perf_counter"] += 0.25
        clocks["process_time"] += 0.75

    monkeypatch.setattr(bench, "perf_counter", lambda: clocks["perf_counter"])
    monkeypatch.setattr(bench, "process_time", lambda: clocks["process_time"])
    assert runs(work, 2, 1.0) == [Run(wall=0.25, cpu=0.75)] * 4
    assert [len(runs(work, 2, seconds)) for seconds in (0.0, 0.4, 1.1)] == [2, 2, 5]


def test_a_run_that_waited_is_disturbed() -> None:
    assert not is_disturbed(Run(wall=1.0, cpu=1.0), 1)
    assert not is_disturbed(Run(wall=1.1, cpu=1.0), 1)
    assert is_disturbed(Run(wall=1.2, cpu=1.0), 1)
    assert not is_disturbed(Run(wall=1.0, cpu=1.95), 2)
    assert is_disturbed(Run(wall=1.0, cpu=1.0), 2)


# POV-Ray.


WHITE = (255, 255, 255)
CONE, DISC, TRIANGLE = MORE[0], MORE[5], MORE[3]
BALL = SHAPES[1]
BUDGET = Budget(0.0, 9.0, tries=1)
SCENE = Scene((AMBIENT, EYE, LAMP, Background((20, 40, 80)), *SHAPES, CONE, DISC, TRIANGLE)).replace(
    BALL, specular=Specular(0.4, 30.0)
)
installed = pytest.mark.skipif(not shutil.which("povray"), reason="needs POV-Ray")


@pytest.mark.parametrize(
    ("scene", "reason"),
    [
        (Scene((*ALL.elements, ParallelLight((0, -1, 0), 0.5, WHITE))), "parallel"),
        (Scene((*ALL.elements, FurtherLight((0, 9, 0), 0.5, WHITE, fade=9.0))), "fading"),
        (Scene((*ALL.elements, MORE[2])), "hyperboloids"),
        (ALL.replace(ALL.shapes[1], checker=Checker(0.1, WHITE)), "material checker "),
        (Scene((*ALL.elements, Background("sky.png"))), "picture as background"),
    ],
)
def test_what_is_not_the_same_there_is_refused(scene: Scene, reason: str) -> None:
    with pytest.raises(match=reason):
        list(translated(scene, 16, 9))


def test_numbers_keep_all_their_digits() -> None:
    text = "\n".join(translated(ALL.replace(BALL, diameter=2 / 3), 16, 9))
    assert f"{1 / 3!r} pigment" in text
    assert "-0.0," not in text


def test_where_it_is_not_installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(RenderError, match="POV-Ray is not installed"):
        PovRay(ALL, 16, 9, 1, tmp_path)


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    """Fewer settings."""
    monkeypatch.setattr(povray, "SETTINGS", (SETTINGS[0], SETTINGS[2], SETTINGS[6]))


@installed
@pytest.mark.usefixtures("few")
def test_its_pictures_converge_to_ours(tmp_path: Path) -> None:
    right = reference(SCENE, 96, 64, 256, seed=3)
    rows = {row.name: row for row, _ in PovRay(SCENE, 96, 64, 1, tmp_path).rows(right, BUDGET, lambda name: None)}
    one, nine, recursive = rows.values()
    assert (one.program, one.label, recursive.label) == ("POV-Ray", "1", "A0.03")
    assert one.rmse > 2.5 * nine.rmse
    assert recursive.rmse < 0.5 * one.rmse
    assert all(row.wall_ms > 0 for row in rows.values())


@installed
@pytest.mark.usefixtures("few")
def test_a_picture_of_something_else_is_refused(tmp_path: Path) -> None:
    """A reference with the ball moved by a tenth of its size."""
    x, y, z = BALL.centre
    right = reference(SCENE.replace(SCENE.shapes[1], centre=(x + 0.24, y, z)), 96, 64, 64, seed=3)
    with pytest.raises(RenderError, match="POV-Ray shows something else: RMSE 0"):
        list(PovRay(SCENE, 96, 64, 1, tmp_path).rows(right, BUDGET, lambda name: None))


def test_a_program_that_fails_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda name: "povray")
    monkeypatch.setattr(povray, "COMMAND", ("false",))
    with pytest.raises(RenderError, match="POV-Ray failed"):
        list(PovRay(ALL, 16, 9, 1, tmp_path).rows(reference(ALL, 16, 9, 2, seed=3), BUDGET, lambda name: None))
