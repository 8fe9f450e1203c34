"""Waits until the program in a window is idle, except for the thread that watches the scene's file."""

from __future__ import annotations

from itertools import count

from tests.idle import Thread, threads, until_idle
from tests.viewer.process_tree import compilers, processor_time, state
from tests.waiting import until


def until_at_rest(process: int, looks: int = 2) -> None:
    """Wait until none of the program's threads has run during `looks` checks in a row."""
    until_idle(process, count().__next__, looks)


def until_events_are_done(process: int) -> None:
    """Wait until the main thread sleeps, so that all input events are handled; pictures may still be rendered."""
    before: Thread | None = None

    def asleep() -> bool:
        nonlocal before
        last, before = before, threads(process)[process]
        return has_ended(process) or (before.asleep and before == last)

    until(asleep, f"the end of the input events of process {process}")


def until_compiled(program: int) -> None:
    """Wait until the program compiles no kernel. Compilers give way to all other processes: on a busy machine they take
    long, but some time passes for them."""

    def times() -> dict[int, int]:
        return {each: processor_time(each) for each in compilers(program)}

    while before := times():
        until(lambda before=before: times() != before, "progress of the compiler")


def has_ended(process: int) -> bool:
    """Whether the program has ended."""
    return state(process)[0] in "ZX"


def until_only_one_runs(process: int, times: int) -> None:
    """Wait until one thread, not the main one, has run `times` times while no other thread ran."""
    before: dict[int, Thread] = {}

    def one_runs() -> bool:
        nonlocal before
        now = threads(process)
        ran = [number for number in now if now[number] != before.get(number) or not now[number].asleep]
        if len(ran) > 1 or process in ran or now.keys() != before.keys():
            before = now
        return any(now[number].switches - before[number].switches >= times for number in ran)

    until(one_runs, f"a stretch in which only one thread of process {process} runs, {times} times")
