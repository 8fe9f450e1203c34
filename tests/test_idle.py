"""Detection of a sleeping program by repeated looks at its threads."""

from __future__ import annotations

import itertools
import os
import sys
from collections.abc import Iterator

import pytest

from tests import idle, processes
from tests.idle import Thread, switches, threads, until_idle
from tests.lines import next_line
from tests.waiting import until

ASLEEP, LATER, RUNS = Thread(True, 7), Thread(True, 8), Thread(False, 7)


class NothingLeftError(Exception):
    """All looks were used up, and no period was long enough."""


@pytest.fixture
def looks(monkeypatch: pytest.MonkeyPatch) -> list[dict[int, Thread]]:
    """States of the threads that successive looks at a process find; NothingLeftError after the last one."""
    seen: list[dict[int, Thread]] = []

    def look(_: int) -> dict[int, Thread]:
        if not seen:
            raise NothingLeftError
        return seen.pop(0)

    monkeypatch.setattr(idle, "threads", look)
    return seen


@pytest.fixture
def clock() -> Iterator[int]:
    """A clock that advances by one step at each reading."""
    return itertools.count()


def test_a_process_whose_threads_sleep_all_the_time_is_idle(looks, clock):
    looks += [{1: ASLEEP, 2: ASLEEP}] * 9
    until_idle(1, clock.__next__, 3)
    assert len(looks) > 0


@pytest.mark.parametrize(
    "seen",
    [
        [{1: ASLEEP, 2: ASLEEP}, {1: ASLEEP, 2: LATER}],  # a thread ran between the looks
        [{1: RUNS}, {1: RUNS}],
        [{1: ASLEEP}, {1: ASLEEP, 2: ASLEEP}],  # a thread was started
    ],
)
def test_a_process_that_runs_between_the_looks_is_not_idle(looks, clock, seen):
    looks += seen * 9
    with pytest.raises(NothingLeftError):
        until_idle(1, clock.__next__, 3)


def test_the_clock_measures_the_period(looks):
    looks += [{1: ASLEEP}] * 9
    with pytest.raises(NothingLeftError):
        until_idle(1, lambda: 7, 3)


def test_threads_may_be_ignored(looks, clock):
    looks += [{1: ASLEEP, 2: ASLEEP}, {1: ASLEEP, 2: LATER}] * 9
    until_idle(1, clock.__next__, 3, awake=[2])


def test_a_process_without_threads_raises(looks, clock):
    looks += [{2: ASLEEP}] * 9
    with pytest.raises(AssertionError, match="no such threads"):
        until_idle(1, clock.__next__, 3, awake=[2])


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc, which only Linux has")
def test_linux_counts_the_context_switches_of_a_thread():
    program = "for line in iter(input, 'end'): print(line, flush=True)"
    with processes.started([sys.executable, "-c", program], stdin=-1, stdout=-1) as process:
        counts = []
        for _ in range(3):
            os.write(process.stdin.fileno(), b"again\n")
            assert next_line(process) == "again"
            until(lambda: threads(process.pid)[process.pid].asleep, "a program that waits for a line")
            counts.append(switches(process.pid))
    assert counts[0] < counts[1] < counts[2]
