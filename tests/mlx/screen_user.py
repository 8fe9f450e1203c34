"""ScreenUser: a simulated user on a screen, by xdotool in a second thread while the loop runs in the main thread."""

from __future__ import annotations

import itertools
import os
import sys
import threading
from typing import TYPE_CHECKING

from tests.idle import threads, until_idle
from tests.mlx.user import Typist
from tests.waiting import until
from tests.windows import Desktop

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from minirt.mlx import Window
    from tests.mlx.contract import Harness
    from tests.mlx.user import User


ROUNDS = 3  # events, the turn that follows them with its hooks, and one to come after that


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


X_NAMES = {
    "shift": "Shift_L",
    "ctrl": "Control_L",
    "escape": "Escape",
    "tab": "Tab",
    "digit_1": "1",
    "keypad_left": "KP_Left",
}
IDLE_LOOKS = 10  # consecutive looks that find the main thread asleep


class ScreenUser(Typist):
    """A user who acts on real windows."""

    def __init__(self, harness: Harness) -> None:
        self._harness = harness
        self._desktop = Desktop(dict(os.environ))
        self._failure: BaseException | None = None
        self._running = threading.Event()
        self._ids = {window: self._desktop.find(window.title) for window in reversed(harness.mlx.windows)}

    def run(self, actions: Callable[[User], object]) -> None:
        """Run the loop while the second thread performs the actions."""
        harness = self._harness
        thread = threading.Thread(target=self._perform, args=(actions,))
        self._running.set()
        thread.start()
        try:
            harness.m.mlx_loop(harness.mlx)
        finally:
            self._running.clear()
            thread.join()
            harness.m.mlx_wake_hook(harness.mlx, None)
        if self._failure is not None:
            raise self._failure

    def _perform(self, actions: Callable[[User], object]) -> None:
        """Perform the actions, wait for the whole log, and end the loop; runs in the second thread."""
        harness = self._harness
        try:
            actions(self)
            until(lambda: self._is_over() or len(harness.log) == len(harness.expected), "the whole log")
            self.wait_until_handled()  # so that a surplus entry is found, too
        except BaseException as failure:
            self._failure = failure
        finally:
            harness.m.mlx_wake_hook(harness.mlx, lambda _: harness.m.mlx_loop_exit(harness.mlx))
            harness.m.mlx_wake(harness.mlx)
            self._desktop.release_keys()

    def press(self, key: str) -> None:
        self._desktop.keydown(X_NAMES.get(key, key))

    def hold_until(self, key: str, enough: Callable[[], bool]) -> None:
        self._call(lambda: set_key_repeat(True))
        try:
            self.press(key)
            self.until(enough)
        finally:
            self._call(lambda: set_key_repeat(False))

    def release(self, key: str) -> None:
        self._desktop.keyup(X_NAMES.get(key, key))

    def move(self, x: int, y: int) -> None:
        self._desktop.move(self._id, x, y)

    def click(self, x: int, y: int, button: int = 1) -> None:
        self._desktop.click(self._id, x, y, button)

    def drop(self, *files: str) -> None:
        self._desktop.run(sys.executable, "-m", "tests.mlx.drag_source", str(self._id), "20", "20", "3", *files)

    def enter(self) -> None:
        self._desktop.move(self._id, 50, 50)

    def leave(self) -> None:
        self._desktop.run("xdotool", "mousemove", "2500", "1500")

    def focus(self, window: Window) -> None:
        self._desktop.activate(self._ids[window])

    def press_to_replace_window(self, key: str) -> None:
        """Press a key that replaces the window, and release it before the new window has the focus."""
        old = self._id
        with self._desktop.manager_paused():
            self.press(key)
            self.until(lambda: not self._desktop.exists(old))
            self.release(key)
        self._ids[self._harness.win] = self._desktop.find(self._harness.win.title)

    def resize(self, width: int, height: int) -> None:
        self._desktop.resize(self._id, width, height)

    def minimise(self) -> None:
        self._desktop.minimise(self._id)

    def restore(self) -> None:
        self._desktop.restore(self._id)

    def close_button(self) -> None:
        self._desktop.close_button(self._id)

    def do(self, action: Callable[[], object]) -> None:
        action()

    def until(self, condition: Callable[[], bool]) -> None:
        until(lambda: condition() or self._is_over(), "the effect in the program")
        assert condition(), f"the effect did not come: the log is {self._harness.log}"

    def wait_until(self, condition: Callable[[], bool], seconds: float) -> None:
        self.until(condition)

    def wait_until_handled(self) -> None:
        """Wait until the loop has handled all events that the X server had for it before this call.

        In the first turn the loop sends a request to the server, whose answer comes after all earlier events. When the
        last turn begins, the hooks of these events were called, and their drawings were sent to the server.
        """
        for _ in range(ROUNDS):
            self._call(_synchronise)

    def wait_until_asleep(self, seconds: float) -> None:
        main = os.getpid()
        until_idle(main, itertools.count().__next__, IDLE_LOOKS, threads(main).keys() - {main})

    def wake(self) -> None:
        self.wait_until_asleep(0.0)
        self._harness.m.mlx_wake(self._harness.mlx)

    def log_picture(self, name: str, read: Callable[[NDArray[np.uint8]], object]) -> None:
        self._log_when_expected(name, lambda: read(self._desktop.screenshot(self._id)))

    def log_title(self) -> None:
        self._log_when_expected(
            "title", lambda: self._desktop.run("xdotool", "getwindowname", str(self._id)).decode().strip()
        )

    @property
    def _id(self) -> int:
        return self._ids[self._harness.win]

    def _is_over(self) -> bool:
        """Whether waiting is useless: the log has diverged, or the loop has ended."""
        return self._harness.has_diverged or not self._running.is_set()

    def _call(self, action: Callable[[], object]) -> None:
        """Call an action in the thread of the loop, and wait until it is done or the loop has ended."""
        done = threading.Event()
        self._harness.mlx.do(lambda: (action(), done.set()))
        until(lambda: done.is_set() or not self._running.is_set(), "a turn of the loop")

    def _log_when_expected(self, name: str, read: Callable[[], object]) -> None:
        """Log the value of `read` as soon as it is the expected one, or its last value after the time limit.

        The value may come later than the hooks: other programs, above all the window manager, run in between."""
        harness = self._harness
        index = next(n for n in range(len(harness.log), len(harness.expected)) if harness.expected[n][0] == name)
        self.until(lambda: len(harness.log) == index)
        self.wait_until_handled()
        value: list[object] = [None]

        def is_expected() -> bool:
            value[0] = read()
            return [name, *value] == harness.expected[index]

        try:
            until(is_expected, f"{name} as expected")
        finally:
            harness.record(name, *value)
