"""`--bench` measures frames that keep the lists of the last one, and frames that need new ones."""

from __future__ import annotations

from itertools import groupby
from typing import Any

import numpy as np
import pytest

from minirt import load
from minirt.rendering import Renderer
from minirt.rendering.packing import visibility
from minirt.report import bench
from minirt.report.bench import Run, is_disturbed, runs
from minirt.scene import Scene
from tests.paths import ROOT

PATH = ROOT / "scenes" / "demo.rt"
SIZE = (16, 9)


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Log each frame and, before it, the making of the lists that it needs."""
    log: list[str] = []

    lists, render = visibility.seen_by_eye, Renderer.render

    def logged_lists(*arguments: Any) -> Any:
        log.append("lists")
        return lists(*arguments)

    def logged_render(renderer: Renderer, scene: Scene, pixels: np.ndarray) -> None:
        render(renderer, scene, pixels)
        if pixels.shape[:2] == SIZE[::-1]:  # not the pixel for which the kernel is prepared
            log.append("frame")

    monkeypatch.setattr(visibility, "seen_by_eye", logged_lists)
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
