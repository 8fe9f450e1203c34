"""Whether the program in a window sleeps, but for the thread that looks at the scene's file now and then."""

from __future__ import annotations

from itertools import count

from tests.idle import Thread, threads, until_idle
from tests.waiting import until


def until_at_rest(process: int, looks: int = 2) -> None:
    """Wait until the program sleeps for as long as the test looks at it so often: it has done what it was told to."""
    until_idle(process, count().__next__, looks)


def until_only_one_runs(process: int, times: int) -> None:
    """Wait for a stretch in which one thread ran so many times, which is not the main one, and no other ran at all."""
    before: dict[int, Thread] = {}

    def alone() -> bool:
        nonlocal before
        now = threads(process)
        others = [number for number in now if now[number] != before.get(number) or not now[number].asleep]
        if len(others) > 1 or process in others or now.keys() != before.keys():
            before = now
        return any(now[number].switches - before[number].switches >= times for number in others)

    until(alone, f"a stretch in which only one thread of process {process} runs, {times} times")
