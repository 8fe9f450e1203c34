"""Loss of the connection to the X server: it was killed, or has closed the connection of this program.

Xlib ends a process whose connection breaks, without Python's knowledge. Its error handler is the last chance to save.
"""

from __future__ import annotations

import ctypes
import os
import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

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
