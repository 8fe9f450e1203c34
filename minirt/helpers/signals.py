"""Signals that ask the program to end: Ctrl+C (SIGINT), SIGTERM, and SIGHUP of a closed terminal.

While the program starts they end it at once, while it works they end the work, so that files are cleared up.
`minirt/__main__.py` imports this module before all others, so it imports little.
"""

from __future__ import annotations

import _signal as signal  # type: ignore[import-not-found]  # without the enumerations of `signal`, whose import takes 2 ms
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from types import FrameType

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import NoReturn

ENDING = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
DEFAULTS = signal.SIG_DFL, signal.default_int_handler

ends: list[Callable[[int], object]] = []  # what a signal does, in the innermost block last
ended: list[int] = []  # the signal that has ended the work, after which further ones do nothing
holds: list[list[int]] = []  # signals that came in each block that holds them


def handle(number: int, _frame: FrameType | None) -> None:
    """Handle a signal: end the work, or keep it until the end of a block that holds signals."""
    if holds:
        holds[0].append(number)
    else:
        ends[-1](number)


def exit_at_once(number: int) -> None:
    """End the process, which has nothing to clear up."""
    if not ended:
        os._exit(128 + number)


def leave_at_once(number: int) -> None:
    """End the process, which has only temporary files to delete: no exception is raised, which a library may drop."""
    leave(128 + number)


def interrupt(number: int) -> None:
    """End the work by KeyboardInterrupt with the number of the signal."""
    if not ended:
        ended.append(number)
        raise KeyboardInterrupt(number)


def handle_from_start() -> None:
    """Let signals end this program at once, with the status 128 + n, until it works."""
    ends.append(exit_at_once)
    for number in ENDING:
        if signal.getsignal(number) in DEFAULTS:
            signal.signal(number, handle)


def raise_again(other_hook: Callable[[sys.UnraisableHookArgs], object], ignored: sys.UnraisableHookArgs) -> None:
    """Send a signal once more whose KeyboardInterrupt was lost: Python drops exceptions of some callbacks, such as
    those of weak references."""
    if ended and isinstance(ignored.exc_value, KeyboardInterrupt):
        from threading import Timer

        Timer(0.01, signal.raise_signal, [ended.pop()]).start()
    else:
        other_hook(ignored)


@contextmanager
def ended_by_signals(end: Callable[[int], object] = interrupt) -> Iterator[None]:
    """Call `end` in the main thread with the number of each signal that asks the program to end. By default the first
    one raises KeyboardInterrupt, and further ones do nothing, so that files are cleared up.

    Signals that are ignored, as under nohup, or that have a handler of another program stay as they are.
    """
    mine = [number for number in ENDING if signal.getsignal(number) in DEFAULTS]
    hook = sys.unraisablehook
    sys.unraisablehook = partial(raise_again, hook)
    ends.append(end)
    try:
        with signal_handlers(*mine, handler=handle):
            yield
    finally:
        ends.remove(end)
        sys.unraisablehook = hook
        if not ends:
            ended.clear()


@contextmanager
def held_signals() -> Iterator[list[int]]:
    """Hold the signals that this module handles until the end of the block; yield the list of those that have come.

    The block is brief, or looks at the list: it starts processes, takes locks or clears up, which an exception at any
    instruction would leave half done. Outside of the main thread, which alone gets signals, nothing changes.
    """
    if not _in_main_thread():
        yield []
        return
    came = holds[-1] if holds else []  # blocks inside of each other have one list
    holds.append(came)
    try:
        yield came
    finally:
        holds.pop()
        if not holds:
            for number in came:
                ends[-1](number)


@contextmanager
def signal_handlers(*numbers: int, handler: Callable[[int, FrameType | None], object] | None = None) -> Iterator[None]:
    """Handle signals by `handler`, if there is one, and restore their handlers at the end.

    Outside of the main thread nothing changes.
    """
    before = {number: signal.getsignal(number) for number in numbers} if _in_main_thread() else {}
    for number in before if handler else ():
        signal.signal(number, handler)
    try:
        yield
    finally:
        for number, old in before.items():
            signal.signal(number, old)


@contextmanager
def interruptible(interrupted: Callable[[], None], wake: Callable[[], None]) -> Iterator[None]:
    """Call `interrupted` in the main thread on Ctrl+C, instead of raising KeyboardInterrupt at any instruction.

    Python runs handlers between two instructions of the main thread, which may sleep in the window system. But it
    writes the signal's number into a socket at once; a thread that reads the socket calls `wake`, which has to make the
    main thread run. A second Ctrl+C raises as usual, which stops a hook that does not return. A program's own handler
    of SIGINT stays, and runs promptly.
    """
    if not _in_main_thread():
        yield
        return
    import socket
    from threading import Thread

    def handle(_number: int, _frame: FrameType | None) -> None:
        signal.signal(signal.SIGINT, signal.default_int_handler)  # the second Ctrl+C raises
        interrupted()

    def watch() -> None:
        while reader.recv(1):
            wake()

    reader, writer = socket.socketpair()
    writer.setblocking(False)
    watcher = Thread(target=watch, daemon=True)
    old_descriptor = signal.set_wakeup_fd(writer.fileno(), warn_on_full_buffer=False)
    watcher.start()
    mine = [signal.SIGINT] if signal.getsignal(signal.SIGINT) is signal.default_int_handler else []
    try:
        with signal_handlers(*mine, handler=handle):
            yield
    finally:
        signal.set_wakeup_fd(old_descriptor)
        writer.close()
        watcher.join()
        reader.close()


def leave(status: int) -> NoReturn:
    """End the process at once: without its threads, which may be inside compiled code, or wait for each other."""
    import atexit

    atexit._run_exitfuncs()  # which delete temporary files
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError, AttributeError, RuntimeError):  # full, closed, or being written to
            stream.flush()
    os._exit(status)


def _in_main_thread() -> bool:
    from threading import current_thread, main_thread

    return current_thread() is main_thread()
