"""Signals that end the window: SIGTERM, and SIGHUP of a closed terminal."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

ENDING = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))


@contextmanager
def ended_by_signals(end: Callable[[int], None]) -> Iterator[None]:
    """Call `end` with the number of a signal that asks the program to end, in the main thread.

    The event loop makes the main thread run for any signal. Signals that are ignored, as under nohup, or that have a
    handler stay as they are. Outside of the main thread nothing changes.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    mine = [number for number in ENDING if signal.getsignal(number) is signal.SIG_DFL]
    for number in mine:
        signal.signal(number, lambda number, _frame: end(number))
    try:
        yield
    finally:
        for number in mine:
            signal.signal(number, signal.SIG_DFL)
