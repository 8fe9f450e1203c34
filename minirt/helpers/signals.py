"""Signals that ask the program to end: Ctrl+C (SIGINT), SIGTERM, and SIGHUP of a closed terminal."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from types import FrameType

ENDING = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))


class Ended(KeyboardInterrupt):
    """A signal has asked the program to end; unfinished files are deleted while this propagates."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self.number = number  # of the signal


def end_work(number: int) -> None:
    """Raise `Ended`, for work without a window."""
    raise Ended(number)


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


def ended_by_signals(end: Callable[[int], None]) -> AbstractContextManager[None]:
    """Call `end` in the main thread with the number of a signal that asks the program to end, and ignore further ones,
    so that files are cleared up.

    Signals that are ignored, as under nohup, or that have a handler stay as they are.
    """
    mine = [number for number in ENDING if signal.getsignal(number) is signal.SIG_DFL]

    def handle(number: int, _frame: FrameType | None) -> None:
        for each in mine:
            signal.signal(each, signal.SIG_IGN)
        end(number)

    return signal_handlers(*mine, handler=handle)


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

    def handle(_number: int, _frame: FrameType | None) -> None:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        interrupted()

    def watch() -> None:
        while reader.recv(1):
            wake()

    reader, writer = socket.socketpair()
    writer.setblocking(False)
    watcher = threading.Thread(target=watch, daemon=True)
    old_descriptor = signal.set_wakeup_fd(writer.fileno(), warn_on_full_buffer=False)
    watcher.start()
    is_mine = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    try:
        with signal_handlers(*[signal.SIGINT] * is_mine, handler=handle):
            yield
    finally:
        signal.set_wakeup_fd(old_descriptor)
        writer.close()
        watcher.join()
        reader.close()


def _in_main_thread() -> bool:
    return threading.current_thread() is threading.main_thread()
