"""Properties and requests of X11 windows that pyglet does not offer: icon, full screen of the window manager.

Nothing here raises if a window manager ignores a request. Windows of pyglet on other systems have no `_x_display`.
"""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

CARDINAL, WINDOW, ATOM = 6, 33, 4  # X11's types of properties
REMOVE, ADD = 0, 1  # requests to change a state
FROM_APPLICATION = 1
CLIENT_MESSAGE = 33  # an event
TO_WINDOW_MANAGER = 1 << 19 | 1 << 20  # masks of events that the root window passes to it


def is_x11(window: Any) -> bool:
    """Whether a pyglet window is one of X11."""
    return hasattr(window, "_x_display")


def set_icon(window: Any, pictures: Sequence[NDArray[np.uint8]]) -> None:
    """Set the icon (_NET_WM_ICON) in several sizes, each (h, w, 4) uint8, BGRA."""
    from pyglet.libs.x11 import xlib

    parts = [np.array([each.shape[1], each.shape[0], *each.view("<u4").ravel()], np.ulonglong) for each in pictures]
    words = np.concatenate(parts).astype(ctypes.c_ulong)  # Xlib takes a long for each word of 32 bits
    xlib.XChangeProperty(
        window._x_display, window._window, _atom(window, "_NET_WM_ICON"), CARDINAL, 32, xlib.PropModeReplace,
        words.ctypes.data_as(ctypes.POINTER(ctypes.c_ubyte)), len(words),
    )  # fmt: skip


def manager_has_full_screen(window: Any) -> bool:
    """Whether a window manager is running that can let a window fill the screen."""
    if not is_x11(window):
        return False
    root, check = window._get_root(), _atom(window, "_NET_SUPPORTING_WM_CHECK")
    manager = _property(window, root, check, WINDOW)
    if not manager or _property(window, manager[0], check, WINDOW) != manager:  # an old one, which has ended
        return False
    supported = _property(window, root, _atom(window, "_NET_SUPPORTED"), ATOM)
    return _atom(window, "_NET_WM_STATE_FULLSCREEN") in supported


def request_full_screen(window: Any, on: bool) -> None:
    """Ask the window manager to let the window fill the screen, or to give it its former size and place."""
    from pyglet.libs.x11 import xlib

    event = xlib.XEvent()
    message = event.xclient
    message.type, message.format, message.window = CLIENT_MESSAGE, 32, window._window
    message.message_type = _atom(window, "_NET_WM_STATE")
    message.data.l[0] = ADD if on else REMOVE
    message.data.l[1] = _atom(window, "_NET_WM_STATE_FULLSCREEN")
    message.data.l[3] = FROM_APPLICATION
    xlib.XSendEvent(window._x_display, window._get_root(), False, TO_WINDOW_MANAGER, ctypes.byref(event))
    xlib.XFlush(window._x_display)


def _atom(window: Any, name: str) -> int:
    from pyglet.libs.x11 import xlib

    return int(xlib.XInternAtom(window._x_display, name.encode(), False))


def _property(window: Any, owner: int, name: int, kind: int) -> list[int]:
    """Return the words of a property of any window, an empty list if it has none."""
    from pyglet.libs.x11 import xlib

    data, count, _ = window.get_single_property(owner, name, kind)
    words = ctypes.cast(data, ctypes.POINTER(ctypes.c_ulong))
    values = [int(words[n]) for n in range(count)] if data else []
    if data:
        xlib.XFree(data)
    return values
