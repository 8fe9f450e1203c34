"""Detect that a program sleeps, by Linux's count of context switches of each of its threads.

A thread that runs, however briefly, and sleeps again has a higher count than before. So a thread that sleeps at both
ends of a period with the same count slept all the time, on any machine and under any load.

The length of the period is given in steps of a clock, which is any counter, such as the context switches of another
program:

    until_idle(process.pid, lambda: switches(other.pid), 30)
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from tests.waiting import until


class Thread(NamedTuple):
    """State of a thread at one moment."""

    asleep: bool
    switches: int  # context switches so far


def threads(process: int) -> dict[int, Thread]:
    """Return the threads of a process by their ids; that of the main thread is the process id."""
    result = {}
    for folder in Path(f"/proc/{process}/task").iterdir():
        with suppress(FileNotFoundError, ProcessLookupError):  # the thread has just ended
            result[int(folder.name)] = _thread((folder / "status").read_text())
    return result


def switches(process: int, thread: int | None = None) -> int:
    """Count the context switches of a thread; by default of the main thread."""
    return threads(process)[process if thread is None else thread].switches


def until_idle(process: int, clock: Callable[[], int], steps: int, awake: Collection[int] = ()) -> None:
    """Wait for a period of `steps` steps of the clock in which no thread of the process ran.

    awake: ids of threads that are ignored.
    """
    before: dict[int, Thread] = {}
    start = 0

    def is_idle() -> bool:
        nonlocal before, start
        end = clock()  # read before the threads are examined; the start of a period is read after that
        now = {number: thread for number, thread in threads(process).items() if number not in awake}
        assert now, f"process {process} has no such threads"
        if now == before and all(thread.asleep for thread in now.values()):
            return end - start >= steps
        before, start = now, clock()
        return False

    until(is_idle, f"a period of {steps} steps in which process {process} sleeps")


def _thread(status: str) -> Thread:
    """Parse the status file of a thread in /proc."""
    fields = dict(line.split(":", 1) for line in status.splitlines())
    counts = (fields[name] for name in ("voluntary_ctxt_switches", "nonvoluntary_ctxt_switches"))
    return Thread(fields["State"].split()[0] == "S", sum(map(int, counts)))
