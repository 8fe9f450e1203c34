"""Calls from another thread into the loop of pyglet on X11, for tests."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from tests.waiting import until

if TYPE_CHECKING:
    from collections.abc import Callable

ROUNDS = 3  # events, the turn that follows them with its hooks, and one to come after that


class Call:
    """An event of pyglet's that calls an action in so many rounds of the loop."""

    def __init__(self, action: Callable[[], object], rounds: int) -> None:
        self.done = threading.Event()
        self._action = action
        self._left = rounds

    def post(self) -> None:
        """From any thread: call the action in the next round."""
        import pyglet.app

        pyglet.app.platform_event_loop.post_event(self, "call")

    def dispatch_event(self, _name: str) -> None:
        """Called by pyglet in the loop's thread."""
        self._action()
        self._left -= 1
        if self._left:
            self.post()
        else:
            self.done.set()


def call_in_loop(action: Callable[[], object], running: Callable[[], bool], rounds: int = 1) -> None:
    """Call the action in the loop's thread and wait until that is done, or the loop does not run any more."""
    call = Call(action, rounds)
    call.post()
    until(lambda: call.done.is_set() or not running(), "a round of the loop")


def fence(running: Callable[[], bool]) -> None:
    """Wait until the loop has handled all that the X server had for it before this call.

    In the first round the server's answer to a request of the loop's own puts all events before it into the loop's
    queue. When the last has begun, their hooks were called, and what they drew has been brought to the server.
    """
    call_in_loop(_synchronise, running, ROUNDS)


def repeat_keys(on: bool) -> None:
    """In the loop's thread: let the X server repeat keys that are held, or not."""
    from pyglet.libs.x11 import xlib

    (xlib.XAutoRepeatOn if on else xlib.XAutoRepeatOff)(_display())
    _synchronise()


def _synchronise() -> None:
    from pyglet.libs.x11 import xlib

    xlib.XSync(_display(), 0)


def _display() -> object:
    """pyglet's connection to the X server."""
    import pyglet.display

    return pyglet.display.get_display()._display
