"""Waits until the program in a window is idle, except for the thread that watches the scene's file."""

from __future__ import annotations

from contextlib import suppress
from itertools import count
from pathlib import Path

from tests.idle import Thread, threads, until_idle
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


# Child processes and process groups of a program, read from /proc (Linux).


def compilers(program: int) -> list[int]:
    """Return the ids of the compiler processes of a program."""
    return [
        each
        for each in processes()
        if parent(each) == program and "from minirt.kernel.compiler import main; main()" in arguments(each)
    ]


def group(program: int) -> list[int]:
    """Return the ids of the running processes in the process group of a program, which has the program's id."""
    return [each for each in processes() if state(each)[0] not in "ZX" and state(each)[2] == str(program)]


def processes() -> list[int]:
    """Return the ids of all processes of the machine."""
    return [int(folder.name) for folder in Path("/proc").glob("[0-9]*")]


def processor_time(process: int) -> int:
    """Return the processor time that a process has used, in ticks of the system; 0 if it has ended."""
    user, kernel = state(process, 13)[11:] or (0, 0)
    return int(user) + int(kernel)


def parent(process: int) -> int:
    """Return the id of the parent process."""
    return int(state(process)[1])


def arguments(process: int) -> list[str]:
    """Return the command line; an empty list if the process has ended."""
    with suppress(OSError):
        return Path(f"/proc/{process}/cmdline").read_text().split("\0")
    return []


def state(process: int, fields: int = 3) -> list[str]:
    """Return the state letter, parent and group of a process, and further fields; the letter is X if it has ended."""
    with suppress(OSError):
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[:fields]
    return ["X", "0", "0"]
