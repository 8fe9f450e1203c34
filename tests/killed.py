"""Processes that are killed at each line of some modules, one after the other: every moment of a piece of work."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator
from types import FrameType
from typing import Any

from tests.processes import in_child


def kill_at_each_line(work: Callable[[], object], modules: tuple[str, ...]) -> Iterator[int]:
    """Do the work in child processes; yield after each: the first is killed before the first line of the modules, the
    second before the second line, and so on until one ends by itself."""
    number = 0
    while is_killed(work, modules, number):
        yield number
        number += 1
    assert number > 10, "the work hardly runs any lines of these modules"
    yield number


def is_killed(work: Callable[[], object], modules: tuple[str, ...], number: int) -> bool:
    """Do the work in a child process that kills itself before line `number`; False where it ended before that."""

    def traced() -> None:
        sys.settrace(killer(modules, number))
        work()

    status = in_child(traced)
    assert status in (0, -signal.SIGKILL), "the work failed"
    return status != 0


def killer(modules: tuple[str, ...], number: int) -> Callable[[FrameType, str, Any], Any]:
    """Return a trace function that kills its process before a line of these modules, the first of which is 0."""
    left = number

    def trace(frame: FrameType, event: str, _: Any) -> Any:
        nonlocal left
        if frame.f_globals.get("__name__", "").rpartition(".")[2] not in modules:
            return None
        if event == "line":
            if not left:
                os.kill(os.getpid(), signal.SIGKILL)
            left -= 1
        return trace

    return trace
