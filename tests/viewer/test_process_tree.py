"""Processor time of other processes, and the wait for their compilers."""

from __future__ import annotations

import os
import subprocess
import sys
from typing import Any

import pytest

from tests.viewer import idle_waits
from tests.viewer.idle_waits import until_compiled
from tests.viewer.process_tree import processor_time
from tests.waiting import until


def test_processor_time_grows_with_work() -> None:
    before = processor_time(os.getpid())
    until(lambda: sum(range(10**5)) > 0 and processor_time(os.getpid()) > before, "processor time for work")


def test_an_ended_process_takes_no_processor_time() -> None:
    with subprocess.Popen([sys.executable, "-c", ""]) as process:
        process.wait()
    assert processor_time(process.pid) == 0


def test_compilers_may_take_long_while_they_work(monkeypatch: pytest.MonkeyPatch) -> None:
    compilers = iter([{7: 1}, {7: 2}, {7: 3, 8: 0}, {8: 1}, {}])
    now: Any = None

    def step(*_: object) -> list[int]:
        nonlocal now
        now = next(compilers)
        return list(now)

    monkeypatch.setattr(idle_waits, "compilers", step)
    monkeypatch.setattr(idle_waits, "processor_time", lambda process: now[process])
    until_compiled(1)
    assert now == {}
    assert next(compilers, None) is None


def test_a_compiler_that_does_nothing_is_a_hang(monkeypatch: pytest.MonkeyPatch) -> None:
    def until_once(condition: Any, what: str) -> None:
        if not condition():
            raise TimeoutError(what)

    monkeypatch.setattr(idle_waits, "compilers", lambda _: [7])
    monkeypatch.setattr(idle_waits, "processor_time", lambda _: 3)
    monkeypatch.setattr(idle_waits, "until", until_once)
    with pytest.raises(TimeoutError, match="progress of the compiler"):
        until_compiled(1)
