"""Signals that ask the program to end: SIGTERM, and SIGHUP of a closed terminal."""

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


@contextmanager
def ended_by_signals(end: Callable[[int], None], once: bool = False) -> Iterator[None]:
    """Call `end` in the main thread with the number of a signal that asks the program to end; `once` ignores further
    ones, so that files are cleared up.

    Signals that are ignored, as under nohup, or that have a handler stay as they are. Outside of the main thread
    nothing changes.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    mine = [number for number in ENDING if signal.getsignal(number) is signal.SIG_DFL]

    def handle(number: int, _frame: FrameType | None) -> None:
        if once:
            for each in mine:
                signal.signal(each, signal.SIG_IGN)
        end(number)

    for number in mine:
        signal.signal(number, handle)
    try:
        yield
    finally:
        for number in mine:
            signal.signal(number, signal.SIG_DFL)


def signals_end_work() -> AbstractContextManager[None]:
    """Raise `Ended` in the main thread on a signal that asks the program to end, while it works without a window."""
    return ended_by_signals(raise_ended, once=True)


def raise_ended(number: int) -> None:
    """Let a signal propagate like Ctrl+C."""
    raise Ended(number)
