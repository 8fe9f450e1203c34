"""SIGTERM and SIGHUP of a closed terminal, while the program works without a window."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

ENDING = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))


class Ended(KeyboardInterrupt):
    """A signal has asked the program to end; unfinished files are deleted while this propagates."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self.number = number  # of the signal


@contextmanager
def signals_end_work() -> Iterator[None]:
    """Raise `Ended` in the main thread on SIGTERM and SIGHUP.

    Further signals are ignored, so that the files are cleared up. Signals that are ignored, as under nohup, or that
    have a handler stay as they are. Outside of the main thread nothing changes.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    mine = [number for number in ENDING if signal.getsignal(number) is signal.SIG_DFL]

    def end(number: int, _frame: FrameType | None) -> None:
        for each in mine:
            signal.signal(each, signal.SIG_IGN)
        raise Ended(number)

    for number in mine:
        signal.signal(number, end)
    try:
        yield
    finally:
        for number in mine:
            signal.signal(number, signal.SIG_DFL)
