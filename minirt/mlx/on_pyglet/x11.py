"""X11 that pyglet does not offer: icon and full screen, keys of any keyboard, drag and drop, the end of the server.

Nothing here raises if a window manager ignores a request. Windows of pyglet on other systems have no `_x_display`.
"""

from __future__ import annotations

import ctypes
import os
import sys
from contextlib import suppress
from functools import partial
from typing import Any, NamedTuple

import numpy as np

with suppress(ImportError):  # other systems have no X11, and no windows for the functions here
    from pyglet.libs.x11 import xlib
from collections.abc import Callable, Sequence

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
    parts = [np.array([each.shape[1], each.shape[0], *each.view("<u4").ravel()], np.ulonglong) for each in pictures]
    words = np.concatenate(parts).astype(ctypes.c_ulong)  # Xlib takes a long for each word of 32 bits
    xlib.XChangeProperty(
        window._x_display, window._window, _atom(window, "_NET_WM_ICON"), CARDINAL, 32, xlib.PropModeReplace,
        words.ctypes.data_as(ctypes.POINTER(ctypes.c_ubyte)), len(words),
    )  # fmt: skip


def manager_has_full_screen(window: Any) -> bool:
    """Whether a window manager is running that can let a window fill the screen."""
    root, check = window._get_root(), _atom(window, "_NET_SUPPORTING_WM_CHECK")
    manager = _property(window, root, check, WINDOW)
    if not manager or _property(window, manager[0], check, WINDOW) != manager:  # an old one, which has ended
        return False
    supported = _property(window, root, _atom(window, "_NET_SUPPORTED"), ATOM)
    return _atom(window, "_NET_WM_STATE_FULLSCREEN") in supported


def request_full_screen(window: Any, on: bool) -> bool:
    """Ask the window manager to let the window fill the screen, or give it its former size again if not `on`.

    Returns False, and asks nothing, on other systems and where no window manager runs that can do this.
    """
    if not is_x11(window) or not manager_has_full_screen(window):
        return False
    event = xlib.XEvent()
    message = event.xclient
    message.type, message.format, message.window = CLIENT_MESSAGE, 32, window._window
    message.message_type = _atom(window, "_NET_WM_STATE")
    message.data.l[0] = ADD if on else REMOVE
    message.data.l[1] = _atom(window, "_NET_WM_STATE_FULLSCREEN")
    message.data.l[3] = FROM_APPLICATION
    xlib.XSendEvent(window._x_display, window._get_root(), False, TO_WINDOW_MANAGER, ctypes.byref(event))
    xlib.XFlush(window._x_display)
    return True


def _atom(window: Any, name: str) -> int:
    return int(xlib.XInternAtom(window._x_display, name.encode(), False))


def _property(window: Any, owner: int, name: int, kind: int) -> list[int]:
    """Return the words of a property of any window, an empty list if it has none."""
    data, count, _ = window.get_single_property(owner, name, kind)
    words = ctypes.cast(data, ctypes.POINTER(ctypes.c_ulong))
    values = [int(words[n]) for n in range(count)] if data else []
    if data:
        xlib.XFree(data)
    return values


# MiniLibX takes the code of a key from the first column of the keyboard map: Shift+1 is 1, and 4 of the keypad is Left.
# A keyboard without Latin letters has none of the letters of shortcuts: they are where American keyboards have them.

KEY_PRESS, KEY_RELEASE = 2, 3  # X11's numbers


class KeyEvent(NamedTuple):
    pressed: bool
    code: int  # from the first column of the keyboard map
    letter: int | None  # Latin letter that the key stands for, where it prints none
    modifiers: int  # pyglet's flags


def report_key_events(window: Any, report: Callable[[KeyEvent | None], None]) -> None:
    """Call report(event) before pyglet handles a key, and report(None) after it; nothing but X11 needs that.

    X11 repeats the press of a held key, without a release.
    """
    if not is_x11(window):
        return
    for handlers in (window._event_handlers, window._view_event_handlers):
        for kind in (KEY_PRESS, KEY_RELEASE):
            if kind in handlers:
                handlers[kind] = partial(handle_key, window, report, handlers[kind])


def handle_key(window: Any, report: Callable[[KeyEvent | None], None], original: Any, event: Any) -> None:
    """Report a key event, and let pyglet handle it, which makes text of it."""
    code = int(xlib.XLookupKeysym(event.xkey, 0))
    if code:
        modifiers = window._translate_modifiers(event.xkey.state)
        report(KeyEvent(event.type == KEY_PRESS, code, latin_letter(window, event), modifiers))
    original(event)
    report(None)


# A letter that the active layout prints nowhere is on the key that has it in another layout of the user, or where
# American keyboards have it. A key that prints a Latin letter keeps it: on a French keyboard nothing changes.

ROWS = {24: "qwertyuiop", 38: "asdfghjkl", 52: "zxcvbnm"}  # by the key code of the first key
POSITIONS = {first + n: ord(letter) for first, row in ROWS.items() for n, letter in enumerate(row)}
LETTERS = range(ord("a"), ord("z") + 1)  # a Latin letter is the same number in X11
PRINTING_KEYS = range(10, 95)  # from 1 to the key beside the left Shift
GROUPS = 4  # layouts between which the user of a display can switch
CORE_KEYBOARD = 0x100  # the keyboard that all programs share
STATE_BYTES = 64  # more than the keyboard's state has, which begins with its group


def latin_letter(window: Any, event: Any) -> int | None:
    """Return the code of the letter that a key event of a pyglet window stands for, None if its own symbol counts."""
    key, group = event.xkey.keycode, event.xkey.state >> 13 & GROUPS - 1
    if key not in POSITIONS or _symbol(window, key, group) in LETTERS:
        return None
    others = (_symbol(window, key, other) for other in range(GROUPS))
    letter = next((each for each in others if each in LETTERS), POSITIONS[key])
    is_printed = any(_symbol(window, other, group) == letter for other in PRINTING_KEYS)
    return None if is_printed else letter


def letter_at(window: Any, american: str) -> str:
    """Return the Latin letter that a key prints: in the active layout, or in the first that has one."""
    state = ctypes.create_string_buffer(STATE_BYTES)
    xlib._lib.XkbGetState(window._x_display, CORE_KEYBOARD, state)
    key = next(key for key, letter in POSITIONS.items() if letter == ord(american))
    symbols = (_symbol(window, key, group) for group in (state.raw[0], *range(GROUPS)))
    return next((chr(each) for each in symbols if each in LETTERS), "")


def _symbol(window: Any, key: int, group: int) -> int:
    """Return the symbol that a key prints without modifiers in a group; group 0 where the key has no such group."""
    lookup = xlib._lib.XkbKeycodeToKeysym  # whose types pyglet does not declare
    lookup.restype, lookup.argtypes = ctypes.c_ulong, [ctypes.c_void_p, ctypes.c_ubyte, ctypes.c_int, ctypes.c_int]
    return int(lookup(window._x_display, key, group, 0) or lookup(window._x_display, key, 0, 0))


# Drag and drop (XDND protocol): pyglet 2.1 fails with a TypeError, which would end the program, when an object with at
# most three data types is dragged into a window: these types are in the message itself, which pyglet reads wrongly.

FILES = "text/uri-list"


def fix_drag_enter(window: Any) -> None:
    """Make a pyglet window read the data types in the message. On other platforms this does nothing."""
    original: Any = getattr(window, "_event_drag_enter", None)

    def read_types(event: Any) -> None:
        source, flags, *types = event.xclient.data.l
        if flags & 1:  # there are more than three types, in a list that pyglet reads correctly
            original(event)
            return
        window._xdnd_source, window._xdnd_version = source, flags >> 24  # the highest byte
        files = window._xdnd_atoms[FILES]
        window._xdnd_format = files if files in types else None  # None: pyglet refuses what is dragged

    if original:
        window._event_drag_enter = read_types


# The X server was killed, or has closed the connection of this program. Xlib ends a process whose connection breaks,
# without Python's knowledge. Its error handler is the last chance to save.

LOST = 1  # exit status
HANDLER = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)
INSTALLED: list[Any] = []  # handlers, which Xlib may call as long as the program runs


def end_program_when_connection_is_lost(save: Callable[[], None]) -> None:
    """Call `save` and end the process with status 1 when the X server is gone. No other system has such a server."""
    if not sys.platform.startswith("linux"):
        return

    def handler(_display: int) -> int:
        try:
            save()
            print("Error\nthe connection to the X server is lost", file=sys.stderr, flush=True)
        finally:
            os._exit(LOST)

    INSTALLED[:] = [HANDLER(handler)]
    ctypes.CDLL(xlib._lib._name).XSetIOErrorHandler(INSTALLED[0])  # the same library, without pyglet's argument types
