"""Runs are timed by wall and processor time, and waiting counts as disturbance."""

from __future__ import annotations

from functools import partial

import pytest

from minirt.helpers import system
from minirt.helpers.system import Run, in_turn, is_disturbed, runs


class Machine:
    """A simulated machine, whose wall and processor time advance only by its work and waits."""

    def __init__(self) -> None:
        self.wall, self.cpu = 100.0, 7.0

    def work(self, seconds: float = 0.25, threads: int = 1) -> None:
        """Use processors for some seconds."""
        self.wall += seconds
        self.cpu += seconds * threads

    def wait(self, seconds: float = 0.25) -> None:
        """Wait without using a processor."""
        self.wall += seconds


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch) -> Machine:
    """A simulated machine in the place of the real clocks."""
    simulated = Machine()
    monkeypatch.setattr(system, "perf_counter", lambda: simulated.wall)
    monkeypatch.setattr(system, "process_time", lambda: simulated.cpu)
    return simulated


def test_the_least_number_of_runs_is_made() -> None:
    done: list[int] = []
    assert len(runs(lambda: done.append(0), 7, 0.0)) == len(done) == 7


def test_works_take_turns() -> None:
    done: list[int] = []
    times = in_turn([partial(done.append, 0), partial(done.append, 1)], 3)
    assert [len(each) for each in times] == [3, 3]
    assert done == [0, 1] * 3


def test_further_runs_fill_the_time(machine: Machine) -> None:
    assert runs(machine.work, 2, 1.0) == [Run(0.25, 0.25)] * 4
    assert len(runs(machine.work, 2, 1.1)) == 5
    assert len(runs(machine.work, 2, 0.4)) == 2


def test_work_takes_processor_time_and_a_wait_does_not(machine: Machine) -> None:
    assert runs(machine.work, 1, 0.0) == [Run(wall=0.25, cpu=0.25)]
    assert runs(machine.wait, 1, 0.0) == [Run(wall=0.25, cpu=0.0)]
    assert runs(partial(machine.work, threads=3), 1, 0.0) == [Run(wall=0.25, cpu=0.75)]


def test_a_run_that_waited_is_disturbed() -> None:
    assert not is_disturbed(Run(wall=1.0, cpu=1.0), 1)
    assert not is_disturbed(Run(wall=1.1, cpu=1.0), 1)
    assert is_disturbed(Run(wall=1.2, cpu=1.0), 1)
    assert not is_disturbed(Run(wall=1.0, cpu=1.95), 2)
    assert is_disturbed(Run(wall=1.0, cpu=1.0), 2)
