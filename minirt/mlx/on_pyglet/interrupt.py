"""Ctrl+C while the main thread sleeps in the platform's event wait.

Python handles a signal between two steps of the main thread's program. That thread may sleep in the window system, and
the signal may even arrive in another thread, so nothing would happen. Here the signal's number, which Python writes
into a socket at once, wakes a thread that nudges the event loop.
"""

from __future__ import annotations

import signal
import socket
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import FrameType


@contextmanager
def interruptible(interrupted: Callable[[], None], nudge: Callable[[], None]) -> Iterator[None]:
    """Ctrl+C calls `interrupted`, in the main thread, instead of raising KeyboardInterrupt anywhere in its program.

    `nudge`, called from another thread, has to make the main thread run. A second Ctrl+C raises as usual, which stops
    a hook that does not come back. A program's own handler of SIGINT stays, and runs promptly.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    reader, writer = socket.socketpair()
    writer.setblocking(False)
    watcher = threading.Thread(target=_watch, args=(reader, nudge), daemon=True)
    old_handler = signal.getsignal(signal.SIGINT)
    old_descriptor = signal.set_wakeup_fd(writer.fileno(), warn_on_full_buffer=False)
    if old_handler is signal.default_int_handler:
        signal.signal(signal.SIGINT, _once(interrupted))
    watcher.start()
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, old_handler)
        signal.set_wakeup_fd(old_descriptor)
        writer.close()
        watcher.join()
        reader.close()


@contextmanager
def handlers_kept() -> Iterator[None]:
    """What happens inside changes no handler of signals for good; pyglet's import does, on macOS."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    kept = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in kept.items():
            signal.signal(number, handler)


def _once(interrupted: Callable[[], None]) -> Callable[[int, FrameType | None], None]:
    def handler(_number: int, _frame: FrameType | None) -> None:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        interrupted()

    return handler


def _watch(reader: socket.socket, nudge: Callable[[], None]) -> None:
    while reader.recv(1):  # nothing comes when the other end is closed
        nudge()
