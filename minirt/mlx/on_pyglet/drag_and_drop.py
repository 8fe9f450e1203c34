"""Drag and drop of files on X11 (XDND protocol): a fix for pyglet 2.1.

pyglet fails with a TypeError, which would end the program, when an object with at most three data types is dragged into
a window: these types are in the message itself, which pyglet reads wrongly.
"""

from __future__ import annotations

from functools import partial
from typing import Any

FILES = "text/uri-list"


def fix_drag_enter(window: Any) -> None:
    """Make a pyglet window read the data types in the message. On other platforms this does nothing."""
    original = getattr(window, "_event_drag_enter", None)
    if original is not None:
        window._event_drag_enter = partial(handle_drag_enter, window, original)


def handle_drag_enter(window: Any, original: Any, event: Any) -> None:
    """Note whether the object that is dragged into the window is a list of files."""
    source, flags, *types = event.xclient.data.l
    if flags & 1:  # there are more than three types, in a list that pyglet reads correctly
        original(event)
        return
    window._xdnd_source, window._xdnd_version = source, flags >> 24
    files = window._xdnd_atoms[FILES]
    window._xdnd_format = files if files in types else None
