"""Call functions in the thread of pyglet's event loop on X11 from another thread."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from tests.waiting import until

if TYPE_CHECKING:
    from collections.abc import Callable

ROUNDS = 3  # events, the turn that follows them with its hooks, and one to come after that


class LoopCall:
    """A pyglet event that calls an action in each of a number of rounds of the loop."""

    def __init__(self, action: Callable[[], object], rounds: int) -> None:
        self.done = threading.Event()
        self._action = action
        self._left = rounds

    def post(self) -> None:
        """Call the action in the next round. May be called from any thread."""
        import pyglet.app

        pyglet.app.platform_event_loop.post_event(self, "call")

    def dispatch_event(self, _name: str) -> None:
        """Call the action; pyglet calls this in the thread of the loop."""
        self._action()
        self._left -= 1
        if self._left:
            self.post()
        else:
            self.done.set()


def call_in_loop(action: Callable[[], object], running: Callable[[], bool], rounds: int = 1) -> None:
    """Call the action in the loop's thread and wait until it is done or the loop has ended."""
    call = LoopCall(action, rounds)
    call.post()
    until(lambda: call.done.is_set() or not running(), "a round of the loop")


def wait_for_events(running: Callable[[], bool]) -> None:
    """Wait until the loop has handled all events that the X server had for it before this call.

    In the first round the loop sends a request to the server, whose answer comes after all earlier events. When the
    last round begins, the hooks of these events were called, and their drawings were sent to the server.
    """
    call_in_loop(_synchronise, running, ROUNDS)


def set_key_repeat(on: bool) -> None:
    """Turn the X server's repetition of held keys on or off. Call this in the thread of the loop."""
    from pyglet.libs.x11 import xlib

    (xlib.XAutoRepeatOn if on else xlib.XAutoRepeatOff)(_display())
    _synchronise()


def _synchronise() -> None:
    """Wait for the X server's answer to all requests so far."""
    from pyglet.libs.x11 import xlib

    xlib.XSync(_display(), 0)


def _display() -> object:
    """pyglet's connection to the X server."""
    import pyglet.display

    return pyglet.display.get_display()._display
