"""Latin letters of keys on keyboards that print other letters, for example Greek or Cyrillic ones, on X11.

A letter that the active layout prints nowhere is on the key that has it in another layout of the user, or where
American keyboards have it. A key that prints a Latin letter keeps it: on a French keyboard nothing changes.
"""

from __future__ import annotations

import ctypes
from typing import Any

ROWS = {24: "qwertyuiop", 38: "asdfghjkl", 52: "zxcvbnm"}  # by the key code of the first key
POSITIONS = {first + n: ord(letter) for first, row in ROWS.items() for n, letter in enumerate(row)}
LETTERS = range(ord("a"), ord("z") + 1)  # a Latin letter is the same number in X11
PRINTING_KEYS = range(10, 95)  # from 1 to the key beside the left Shift
GROUPS = 4  # layouts between which the user of a display can switch


def latin_letter(window: Any, event: Any) -> int | None:
    """Return the code of the letter that a key event of a pyglet window stands for, None if its own symbol counts."""
    key, group = event.xkey.keycode, event.xkey.state >> 13 & GROUPS - 1
    if key not in POSITIONS or _symbol(window, key, group) in LETTERS:
        return None
    others = (_symbol(window, key, other) for other in range(GROUPS))
    letter = next((each for each in others if each in LETTERS), POSITIONS[key])
    is_printed = any(_symbol(window, other, group) == letter for other in PRINTING_KEYS)
    return None if is_printed else letter


def _symbol(window: Any, key: int, group: int) -> int:
    """Return the symbol that a key prints without modifiers in a group; group 0 where the key has no such group."""
    lookup = _xlib().XkbKeycodeToKeysym
    return int(lookup(window._x_display, key, group, 0) or lookup(window._x_display, key, 0, 0))


def _xlib() -> Any:
    """Return Xlib, with the types of a function that pyglet does not declare."""
    from pyglet.libs.x11 import xlib

    function = xlib._lib.XkbKeycodeToKeysym
    function.restype, function.argtypes = ctypes.c_ulong, [ctypes.c_void_p, ctypes.c_ubyte, ctypes.c_int, ctypes.c_int]
    return xlib._lib
