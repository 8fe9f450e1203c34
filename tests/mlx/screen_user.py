"""The user of the window contract on a screen: xdotool in a second thread, while the loop runs in the first."""

from __future__ import annotations

import itertools
import os
import sys
import threading
from typing import TYPE_CHECKING

from tests.idle import threads, until_idle
from tests.mlx.loop_calls import call_in_loop, fence, repeat_keys
from tests.mlx.user import User
from tests.waiting import until
from tests.windows import Desktop

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from minirt.mlx import Window
    from tests.mlx.stage import Stage

X_NAMES = {"shift": "Shift_L", "ctrl": "Control_L", "escape": "Escape", "tab": "Tab"}
REST = 10  # looks at a main thread that sleeps all the while


class ScreenUser(User):
    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self._desktop = Desktop(dict(os.environ))
        self._failure: BaseException | None = None
        self._running = threading.Event()
        self._ids = {window: self._desktop.find(window.title) for window in reversed(stage.mlx.windows)}

    def play(self, acts: Callable[[User], object]) -> None:
        stage = self._stage
        hands = threading.Thread(target=self._act, args=(acts,))
        self._running.set()
        hands.start()
        try:
            stage.m.mlx_loop(stage.mlx)
        finally:
            self._running.clear()
            hands.join()
            stage.m.mlx_wake_hook(stage.mlx, None)
        if self._failure is not None:
            raise self._failure

    def _act(self, acts: Callable[[User], object]) -> None:
        """The second thread: do what the user does, wait for the whole log, and end the loop."""
        stage = self._stage
        try:
            acts(self)
            until(lambda: self._is_over() or len(stage.log) == len(stage.expected), "the whole log")
            self.settle()  # and nothing too much
        except BaseException as failure:
            self._failure = failure
        finally:
            stage.m.mlx_wake_hook(stage.mlx, lambda _: stage.m.mlx_loop_exit(stage.mlx))
            stage.m.mlx_wake(stage.mlx)
            self._desktop.let_go()

    def hold(self, key: str) -> None:
        self._desktop.keydown(X_NAMES.get(key, key))

    def hold_until(self, key: str, enough: Callable[[], bool]) -> None:
        self._call(lambda: repeat_keys(True))
        try:
            self.hold(key)
            self.until(enough)
        finally:
            self._call(lambda: repeat_keys(False))

    def let_go(self, key: str) -> None:
        self._desktop.keyup(X_NAMES.get(key, key))

    def move(self, x: int, y: int) -> None:
        self._desktop.move(self._id, x, y)

    def click(self, x: int, y: int, button: int = 1) -> None:
        self._desktop.click(self._id, x, y, button)

    def drop(self, *files: str) -> None:
        self._desktop.run(sys.executable, "-m", "tests.mlx.dropper", str(self._id), "20", "20", "3", *files)

    def enter(self) -> None:
        self._desktop.move(self._id, 50, 50)

    def leave(self) -> None:
        self._desktop.run("xdotool", "mousemove", "2500", "1500")

    def focus(self, window: Window) -> None:
        self._desktop.activate(self._ids[window])

    def press_for_another_window(self, key: str) -> None:
        old = self._id
        with self._desktop.manager_stopped():
            self.hold(key)
            self.until(lambda: not self._desktop.is_there(old))
            self.let_go(key)
        self._ids[self._stage.win] = self._desktop.find(self._stage.win.title)

    def resize(self, width: int, height: int) -> None:
        self._desktop.resize(self._id, width, height)

    def minimise(self) -> None:
        self._desktop.minimise(self._id)

    def restore(self) -> None:
        self._desktop.restore(self._id)

    def close_button(self, window: Window | None = None) -> None:
        self._desktop.close_button(self._ids[window or self._stage.win])

    def then(self, action: Callable[[], object]) -> None:
        action()

    def until(self, condition: Callable[[], bool]) -> None:
        until(lambda: condition() or self._is_over(), "what the program does")
        assert condition(), f"the user waits in vain: the log is {self._stage.log}"

    def wait_until(self, condition: Callable[[], bool], seconds: float) -> None:
        self.until(condition)

    def settle(self) -> None:
        fence(self._running.is_set)

    def rest(self, seconds: float) -> None:
        main = os.getpid()
        until_idle(main, itertools.count().__next__, REST, threads(main).keys() - {main})

    def wake(self) -> None:
        self.rest(0.0)
        self._stage.m.mlx_wake(self._stage.mlx)

    def look(self, name: str, see: Callable[[NDArray[np.uint8]], object]) -> None:
        self._observe(name, lambda: see(self._desktop.screenshot(self._id)))

    def read_title(self) -> None:
        self._observe("title", lambda: self._desktop.run("xdotool", "getwindowname", str(self._id)).decode().strip())

    @property
    def _id(self) -> int:
        return self._ids[self._stage.win]

    def _is_over(self) -> bool:
        """Whether nothing that anybody waits for will come."""
        return self._stage.astray or not self._running.is_set()

    def _call(self, action: Callable[[], object]) -> None:
        call_in_loop(action, self._running.is_set)

    def _observe(self, name: str, see: Callable[[], object]) -> None:
        """Log what `see` returns, once it is what the log must have there, or else what it was at last.

        It may come later than the hooks: other programs, the window manager above all, take their turns, too."""
        stage = self._stage
        place = next(n for n in range(len(stage.log), len(stage.expected)) if stage.expected[n][0] == name)
        self.until(lambda: len(stage.log) == place)
        self.settle()
        seen: list[object] = [None]

        def right() -> bool:
            seen[0] = see()
            return [name, *seen] == stage.expected[place]

        try:
            until(right, f"{name} as it must be")
        finally:
            stage.note(name, *seen)
