"""`--bench` measures frames that keep the lists of the last one and frames that do not; runs that waited are known."""

from __future__ import annotations

from itertools import count, groupby
from math import isnan
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from minirt import load
from minirt.rendering.packing.visibility import Bins
from minirt.rendering.renderer import Renderer
from minirt.report import bench
from minirt.report.bench import Run, is_disturbed, runs, take_turns, waiting_time
from minirt.scene import Scene
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

    def logged_render(renderer: Renderer, scene: Scene, pixels: np.ndarray, samples: int = 1) -> None:
        render(renderer, scene, pixels, samples)
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
    waited = count(3.0, 0.125)
    monkeypatch.setattr(bench, "waiting_time", lambda: next(waited))
    assert runs(work, 2, 1.0) == [Run(wall=0.25, cpu=0.75, waited=0.125)] * 4
    assert [len(runs(work, 2, seconds)) for seconds in (0.0, 0.4, 1.1)] == [2, 2, 5]


def test_a_run_that_waited_is_disturbed() -> None:
    """The time missing from the wall time of all threads counts where the system tells no waiting time."""
    for run, threads, disturbed in (
        (Run(wall=1.0, cpu=1.0), 1, False),
        (Run(wall=1.1, cpu=1.0), 1, False),
        (Run(wall=1.2, cpu=1.0), 1, True),
        (Run(wall=1.0, cpu=1.95), 2, False),
        (Run(wall=1.0, cpu=1.0), 2, True),
        (Run(wall=1.0, cpu=1.0, waited=0.1), 16, False),  # a part that one thread does is no disturbance
        (Run(wall=1.0, cpu=1.0, waited=0.2), 1, True),
    ):
        assert is_disturbed(run, threads) == disturbed


def test_waiting_for_a_processor_is_told_of_each_thread(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Linux gives nanoseconds: time on a processor, time in the queue, time slices."""
    for name, text in (("7", "900 250000000 3\n"), ("8", "0 500000000 1\n"), ("9", "")):
        (tmp_path / name).mkdir()
        if text:
            (tmp_path / name / "schedstat").write_text(text)
    monkeypatch.setattr(bench, "THREADS", tmp_path)
    assert waiting_time() == 0.75
    monkeypatch.setattr(bench, "THREADS", tmp_path / "none")
    assert isnan(waiting_time())


def test_works_take_turns_in_both_orders_until_the_time_is_over() -> None:
    log: list[str] = []

    def work(name: str) -> Run:
        log.append(name)
        return Run(0.5, 0.25)

    works = [lambda: work("a"), lambda: work("b")]
    assert take_turns(works, 1, 9, 2.5) == [(Run(0.5, 0.25),) * 2] * 3
    assert "".join(log) == "abbaab"
    assert [len(take_turns(works, least, most, seconds)) for least, most, seconds in ((2, 9, 0.0), (1, 4, 99.0))] == [
        2,
        4,
    ]
