"""Keys and buttons while the help is open: letters search it, arrows and the wheel turn its pages."""

from __future__ import annotations

from minirt.mlx import Button, Key
from minirt.viewer.app.session import Session
from minirt.viewer.bindings import SIGNIFICANT, Binding

HELP = "toggle help"  # the action that opens it
TURNS: dict[int, int] = {  # keys and buttons that turn its pages
    **dict.fromkeys((Key.RIGHT, Key.DOWN, Key.PAGE_DOWN, Key.RETURN, Button.WHEEL_DOWN), 1),
    **dict.fromkeys((Key.LEFT, Key.UP, Key.PAGE_UP, Button.WHEEL_UP), -1),
}


def help_takes(session: Session, key: int, pressed: Binding | None) -> bool:
    """Take a key press or button while the help is open; False if it is closed or the key means nothing to it.

    key: a code of a key, with the binding that is `pressed`, or a button. Letters search the help, arrows and the wheel
    turn its pages. Escape, a click, and the key of the help while nothing is searched, close it.
    """
    screen = session.screen
    if not screen.help:
        return False
    closes = pressed is not None and pressed.action == HELP and not screen.search
    if closes or key in (Key.ESCAPE, Button.LEFT, Button.MIDDLE, Button.RIGHT):
        screen.turn_help(0)
    elif key in TURNS:
        screen.turn_help(TURNS[key])
    elif session.modifiers & SIGNIFICANT:
        return False
    elif Key.A <= key <= Key.Z or key == Key.SPACE:
        screen.help, screen.search = 1, screen.search + chr(key)
    elif key == Key.BACKSPACE:
        screen.help, screen.search = 1, screen.search[:-1]
    else:
        return False
    session.refresh()
    return True
