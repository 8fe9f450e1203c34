"""Files that are dragged to a window on X11, by the protocol XDND.

pyglet 2.1 fails with a TypeError, which would end the program, where what comes into a window has three types or fewer:
they are in the message itself, and it looks for them in the wrong way.
"""

from __future__ import annotations

from functools import partial
from typing import Any

FILES = "text/uri-list"


def mend(window: Any) -> None:
    """Let this window of pyglet read the types in the message; on other platforms there is nothing to do."""
    known = getattr(window, "_event_drag_enter", None)
    if known is not None:
        window._event_drag_enter = partial(entered, window, known)


def entered(window: Any, known: Any, event: Any) -> None:
    """Something was dragged into the window: remember whether it is files."""
    source, about, *types = event.xclient.data.l
    if about & 1:  # there are more types, and a list of them
        known(event)
        return
    window._xdnd_source, window._xdnd_version = source, about >> 24
    files = window._xdnd_atoms[FILES]
    window._xdnd_format = files if files in types else None
