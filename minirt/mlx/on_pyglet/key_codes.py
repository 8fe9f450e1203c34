"""Key codes on X11: the symbol that a key prints without modifiers, which pyglet does not report.

MiniLibX takes it from the first column of the keyboard map: Shift+1 is 1, and 4 of the keypad is Left.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

KEY_PRESS, KEY_RELEASE = 2, 3  # X11's numbers


def report_key_codes(window: Any, report: Callable[[bool, int, int], None]) -> bool:
    """Call report(pressed, code, pyglet's modifiers) before pyglet handles a key; False if this is not X11.

    X11 repeats the press of a held key, without a release.
    """
    if not hasattr(window, "_x_display"):
        return False
    for handlers in (window._event_handlers, window._view_event_handlers):
        for kind in (KEY_PRESS, KEY_RELEASE):
            if kind in handlers:
                handlers[kind] = partial(handle_key, window, report, handlers[kind])
    return True


def handle_key(window: Any, report: Callable[[bool, int, int], None], original: Any, event: Any) -> None:
    """Report a key event, and let pyglet handle it, which makes text of it."""
    from pyglet.libs.x11.xlib import XLookupKeysym

    code = XLookupKeysym(event.xkey, 0)
    if code:
        report(event.type == KEY_PRESS, int(code), window._translate_modifiers(event.xkey.state))
    original(event)
