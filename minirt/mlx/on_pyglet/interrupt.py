"""Handle Ctrl+C promptly while the main thread sleeps in the platform's event wait, and the loss of the X server.

Python runs signal handlers between two instructions of the main thread. That thread may sleep in the window system,
and the signal may even arrive in another thread, so the handler would not run. Python writes the signal's number into a
socket at once (`signal.set_wakeup_fd`); a thread that reads the socket wakes the event loop.
"""

from __future__ import annotations

import ctypes
import os
import signal
import socket
import sys
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import FrameType


@contextmanager
def interruptible(interrupted: Callable[[], None], wake: Callable[[], None]) -> Iterator[None]:
    """Call `interrupted` in the main thread on Ctrl+C, instead of raising KeyboardInterrupt at any instruction.

    `wake` is called from another thread and has to make the main thread run. A second Ctrl+C raises as usual, which
    stops a hook that does not return. A program's own handler of SIGINT stays, and runs promptly.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    reader, writer = socket.socketpair()
    writer.setblocking(False)
    watcher = threading.Thread(target=_watch, args=(reader, wake), daemon=True)
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
def signal_handlers_preserved() -> Iterator[None]:
    """Restore the handlers of SIGINT and SIGTERM afterwards: pyglet's import changes them on macOS."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)


def _once(interrupted: Callable[[], None]) -> Callable[[int, FrameType | None], None]:
    """Make a handler that calls `interrupted` and restores Python's handler, which raises KeyboardInterrupt."""

    def handler(_number: int, _frame: FrameType | None) -> None:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        interrupted()

    return handler


def _watch(reader: socket.socket, wake: Callable[[], None]) -> None:
    """Call `wake` for each signal until the other end of the socket is closed."""
    while reader.recv(1):
        wake()


# The X server was killed, or has closed the connection of this program. Xlib ends a process whose connection breaks,
# without Python's knowledge. Its error handler is the last chance to save.


STATUS = 1
HANDLER = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)
INSTALLED: list[Any] = []  # handlers, which Xlib may call as long as the program runs


def end_program_when_connection_is_lost(save: Callable[[], None]) -> None:
    """Call `save` and end the process with status 1 when the X server is gone. No other system has such a server."""
    if not sys.platform.startswith("linux"):
        return
    from pyglet.libs.x11 import xlib

    def handler(_display: int) -> int:
        try:
            save()
            print("Error\nthe connection to the X server is lost", file=sys.stderr, flush=True)
        finally:
            os._exit(STATUS)

    INSTALLED[:] = [HANDLER(handler)]
    ctypes.CDLL(xlib._lib._name).XSetIOErrorHandler(INSTALLED[0])  # the same library, without pyglet's argument types
