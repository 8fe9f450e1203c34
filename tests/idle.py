"""Whether a program sleeps, by Linux's count of how often each of its threads gave up a processor or lost it.

A thread that runs, however shortly, and sleeps again has a higher count than before. So a thread that sleeps at both
ends of a stretch, with the same count, slept all the while, on any machine and under any load.

How long a stretch has to be is said in steps of a clock, which is anything that counts up, such as the turns of another
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
    """A thread at one moment."""

    asleep: bool
    switches: int  # how often it gave up a processor or lost it


def threads(process: int) -> dict[int, Thread]:
    """The threads of a process by Linux's numbers; the main thread's is that of the process."""
    found = {}
    for folder in Path(f"/proc/{process}/task").iterdir():
        with suppress(FileNotFoundError, ProcessLookupError):  # it ended while we looked
            found[int(folder.name)] = _thread((folder / "status").read_text())
    return found


def switches(process: int, thread: int | None = None) -> int:
    """Count how often a thread gave up a processor or lost it; without a number it is the main thread."""
    return threads(process)[process if thread is None else thread].switches


def until_idle(process: int, clock: Callable[[], int], steps: int, awake: Collection[int] = ()) -> None:
    """Wait for a stretch of so many steps of the clock in which no thread of the process ran.

    `awake`: numbers of threads that may run all the same.
    """
    before: dict[int, Thread] = {}
    start = 0

    def still() -> bool:
        nonlocal before, start
        end = clock()  # before the threads are looked at, and after that where a stretch begins
        now = {number: thread for number, thread in threads(process).items() if number not in awake}
        assert now, f"process {process} has no such threads"
        if now == before and all(thread.asleep for thread in now.values()):
            return end - start >= steps
        before, start = now, clock()
        return False

    until(still, f"a stretch of {steps} steps in which process {process} sleeps")


def _thread(status: str) -> Thread:
    """Read what Linux says of a thread."""
    fields = dict(line.split(":", 1) for line in status.splitlines())
    counts = (fields[name] for name in ("voluntary_ctxt_switches", "nonvoluntary_ctxt_switches"))
    return Thread(fields["State"].split()[0] == "S", sum(map(int, counts)))
