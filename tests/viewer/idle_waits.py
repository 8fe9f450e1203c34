"""Whether the program in a window sleeps, but for the thread that looks at the scene's file now and then."""

from __future__ import annotations

from itertools import count

from tests.idle import Thread, threads, until_idle
from tests.viewer.process_tree import state
from tests.waiting import until


def until_at_rest(process: int, looks: int = 2) -> None:
    """Wait for a stretch in which the test looks at the program so often and none of its threads runs."""
    until_idle(process, count().__next__, looks)


def until_events_are_done(process: int) -> None:
    """Wait until the main thread sleeps: what the user did is not in a queue any more. Pictures may still be made."""
    before: Thread | None = None

    def asleep() -> bool:
        nonlocal before
        last, before = before, threads(process)[process]
        return has_ended(process) or (before.asleep and before == last)

    until(asleep, f"the end of what process {process} was told")


def has_ended(process: int) -> bool:
    """Whether the program runs no more; nobody needs to wait for what it does, then."""
    return state(process)[0] in "ZX"


def until_only_one_runs(process: int, times: int) -> None:
    """Wait for a stretch in which one thread ran so many times, which is not the main one, and no other ran at all."""
    before: dict[int, Thread] = {}

    def alone() -> bool:
        nonlocal before
        now = threads(process)
        ran = [number for number in now if now[number] != before.get(number) or not now[number].asleep]
        if len(ran) > 1 or process in ran or now.keys() != before.keys():
            before = now
        return any(now[number].switches - before[number].switches >= times for number in ran)

    until(alone, f"a stretch in which only one thread of process {process} runs, {times} times")
