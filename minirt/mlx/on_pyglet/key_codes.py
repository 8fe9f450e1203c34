"""Keys on X11: what pyglet does not report about them.

MiniLibX takes the code of a key from the first column of the keyboard map: Shift+1 is 1, and 4 of the keypad is Left.
A keyboard without Latin letters has none of the letters of shortcuts: they are where American keyboards have them.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from minirt.mlx.on_pyglet.latin_letters import latin_letter

if TYPE_CHECKING:
    from collections.abc import Callable

KEY_PRESS, KEY_RELEASE = 2, 3  # X11's numbers


class KeyEvent(NamedTuple):
    """A press or a release of a key."""

    pressed: bool
    code: int  # from the first column of the keyboard map
    letter: int | None  # Latin letter that the key stands for, where it prints none
    modifiers: int  # pyglet's flags


def report_key_events(window: Any, report: Callable[[KeyEvent | None], None]) -> None:
    """Call report(event) before pyglet handles a key, and report(None) after it; nothing but X11 needs that.

    X11 repeats the press of a held key, without a release.
    """
    if not hasattr(window, "_x_display"):
        return
    for handlers in (window._event_handlers, window._view_event_handlers):
        for kind in (KEY_PRESS, KEY_RELEASE):
            if kind in handlers:
                handlers[kind] = partial(handle_key, window, report, handlers[kind])


def handle_key(window: Any, report: Callable[[KeyEvent | None], None], original: Any, event: Any) -> None:
    """Report a key event, and let pyglet handle it, which makes text of it."""
    from pyglet.libs.x11.xlib import XLookupKeysym

    code = int(XLookupKeysym(event.xkey, 0))
    if code:
        modifiers = window._translate_modifiers(event.xkey.state)
        report(KeyEvent(event.type == KEY_PRESS, code, latin_letter(window, event), modifiers))
    original(event)
    report(None)
