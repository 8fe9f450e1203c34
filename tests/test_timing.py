"""Runs are timed, and a wait is told from work."""

from __future__ import annotations

import time
from functools import partial
from itertools import count

import pytest

from minirt import timing
from minirt.timing import Run, in_turn, is_disturbed, runs


def work() -> None:
    """A hundredth of a second of a processor."""
    end = time.thread_time() + 0.01
    while time.thread_time() < end:
        pass


def test_as_many_runs_as_are_asked_for() -> None:
    done: list[int] = []
    assert len(runs(lambda: done.append(0), 7, 0.0)) == len(done) == 7


def test_works_take_turns() -> None:
    done: list[int] = []
    times = in_turn([partial(done.append, 0), partial(done.append, 1)], 3)
    assert [len(each) for each in times] == [3, 3]
    assert done == [0, 1] * 3


def test_and_more_to_fill_the_time(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = count()
    monkeypatch.setattr(timing, "perf_counter", lambda: next(clock) * 0.25)
    assert [run.wall for run in runs(lambda: None, 2, 1.0)] == [0.25] * 4


def test_work_takes_a_processor_and_sleep_does_not() -> None:
    best = min(runs(work, 3, 0.0))
    assert best.wall >= best.cpu * 0.99
    assert best.cpu == pytest.approx(0.01, rel=0.1)
    slept = min(runs(lambda: time.sleep(0.02), 2, 0.0))
    assert slept.wall >= 0.02 > 10 * slept.cpu


def test_who_waits_is_disturbed() -> None:
    assert not is_disturbed(Run(wall=1.0, cpu=1.0), 1)
    assert not is_disturbed(Run(wall=1.1, cpu=1.0), 1)
    assert is_disturbed(Run(wall=1.2, cpu=1.0), 1)
    assert not is_disturbed(Run(wall=1.0, cpu=1.95), 2)
    assert is_disturbed(Run(wall=1.0, cpu=1.0), 2)
