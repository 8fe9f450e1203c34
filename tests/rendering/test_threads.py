"""Threads of a pool give way to the others of the process when they are asked to."""

from __future__ import annotations

import _thread
import gc
import os
import sys
from pathlib import Path
from threading import Event

import pytest

from minirt.rendering import threads
from minirt.rendering.threads import NICENESS, ThreadPool, usable_cores
from tests.waiting import HANG_LIMIT


def nicenesses(pool: ThreadPool) -> list[int]:
    """Niceness of each thread of a pool above that of the process."""
    ids = [thread.native_id or 0 for thread in pool.threads]
    return [os.getpriority(os.PRIO_PROCESS, each) - os.getpriority(os.PRIO_PROCESS, os.getpid()) for each in ids]


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux has priorities of threads")
@pytest.mark.skipif(os.getpriority(os.PRIO_PROCESS, 0) > 19 - NICENESS, reason="the process itself gives way")
def test_only_the_threads_of_the_pool_give_way() -> None:
    pool, other = ThreadPool(2), ThreadPool(2)
    assert nicenesses(pool) == [0, 0]
    before = os.getpriority(os.PRIO_PROCESS, 0)
    pool.give_way()
    assert nicenesses(pool) == [NICENESS, NICENESS]
    pool.give_way()
    assert nicenesses(pool) == [NICENESS, NICENESS]
    assert nicenesses(other) == [0, 0]
    assert os.getpriority(os.PRIO_PROCESS, 0) == before


def test_an_error_of_a_job_is_raised_and_cancels_the_others() -> None:
    cancelled = Event()
    with pytest.raises(ZeroDivisionError):
        ThreadPool(3).run([lambda: 1 / 0, lambda: cancelled.wait(HANG_LIMIT)], cancelled.set)
    assert cancelled.is_set()


def test_ctrl_c_just_before_the_wait_is_seen() -> None:
    """`interrupt_main` does what the handler of a signal does, but ends no wait of the main thread."""
    cancelled, seen = Event(), list[bool]()

    def job() -> None:
        _thread.interrupt_main()
        seen.append(cancelled.wait(HANG_LIMIT))

    with pytest.raises(KeyboardInterrupt):
        ThreadPool(1).run([job], cancelled.set)
    assert seen == [True]


def test_the_threads_of_a_dropped_pool_end() -> None:
    pool = ThreadPool(2)
    threads = pool.threads
    del pool
    gc.collect()
    for thread in threads:
        thread.join(HANG_LIMIT)
        assert not thread.is_alive()


# The number of usable processors: affinity of the process, limit of its container.


@pytest.fixture(autouse=True)
def machine(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A machine with eight processors, and the file that limits its container."""
    monkeypatch.setattr(os, "sched_getaffinity", lambda pid: set(range(8)), raising=False)
    monkeypatch.setattr(threads, "QUOTA", tmp_path / "cpu.max")
    return tmp_path / "cpu.max"


@pytest.mark.parametrize(
    ("quota", "expected"),
    [
        ("max 100000", 8),
        ("200000 100000", 2),
        ("350000 100000", 4),
        ("50000 100000", 1),
        ("1000 100000", 1),
        ("1600000 100000", 8),
        ("150000 50000\n", 3),
        ("", 8),
        ("what is this", 8),
    ],
)
def test_a_container_limits_the_number(machine: Path, quota: str, expected: int) -> None:
    machine.write_text(quota)
    assert usable_cores() == expected


def test_without_a_container_all_processors_count() -> None:
    assert usable_cores() == 8


def test_the_affinity_of_the_process_limits_the_number(monkeypatch: pytest.MonkeyPatch) -> None:
    own = {0: {3, 5}}  # 0 stands for the calling process
    monkeypatch.setattr(os, "sched_getaffinity", own.__getitem__)
    assert usable_cores() == 2


@pytest.mark.parametrize(("count", "expected"), [(6, 6), (None, 1)])
def test_without_affinities_all_processors_count(
    monkeypatch: pytest.MonkeyPatch, count: int | None, expected: int
) -> None:
    monkeypatch.delattr(os, "sched_getaffinity")
    monkeypatch.setattr(os, "cpu_count", lambda: count)
    assert usable_cores() == expected
