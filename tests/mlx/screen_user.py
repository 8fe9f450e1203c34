"""The user of the window contract on a screen: xdotool in a second thread, while the loop runs in the first."""

from __future__ import annotations

import os
import sys
import threading
import time
from typing import TYPE_CHECKING

from tests.mlx.user import User
from tests.windows import Desktop, until

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from minirt.mlx import Window
    from tests.mlx.stage import Stage

X_NAMES = {"shift": "Shift_L", "ctrl": "Control_L", "escape": "Escape", "tab": "Tab"}


class ScreenUser(User):
    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self._desktop = Desktop(dict(os.environ))
        self._failure: BaseException | None = None
        self._ids = {window: self._desktop.find(window.title) for window in reversed(stage.mlx.windows)}

    def play(self, acts: Callable[[User], object]) -> None:
        def program() -> None:
            try:
                acts(self)
                until(lambda: len(stage.log) >= stage.expected or not running.is_set(), "the whole log", 3.0)
                time.sleep(0.1)  # for what may come too much
            except BaseException as failure:
                self._failure = failure
            finally:
                stage.m.mlx_wake_hook(stage.mlx, lambda _: stage.m.mlx_loop_exit(stage.mlx))
                stage.m.mlx_wake(stage.mlx)

        stage = self._stage
        running = threading.Event()
        running.set()
        hands = threading.Thread(target=program)
        hands.start()
        try:
            stage.m.mlx_loop(stage.mlx)
        finally:
            running.clear()
            hands.join()
            stage.m.mlx_wake_hook(stage.mlx, None)
        if self._failure is not None:
            raise self._failure

    @property
    def _id(self) -> int:
        return self._ids[self._stage.win]

    def hold(self, key: str) -> None:
        self._desktop.keydown(X_NAMES.get(key, key))

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

    def resize(self, width: int, height: int) -> None:
        self._desktop.resize(self._id, width, height)

    def minimise(self) -> None:
        self._desktop.minimise(self._id)

    def restore(self) -> None:
        self._desktop.restore(self._id)

    def close_button(self, window: Window | None = None) -> None:
        self._desktop.close_button(self._ids[window or self._stage.win])

    def wait(self, seconds: float) -> None:
        time.sleep(seconds)

    def until(self, condition: Callable[[], bool]) -> None:
        until(condition, "what the program does", 3.0)

    def then(self, action: Callable[[], object]) -> None:
        action()

    def await_wake(self) -> None:
        until(lambda: len(self._stage.log) >= self._stage.expected, "what the wake hook does", 3.0)

    def look(self, name: str, see: Callable[[NDArray[np.uint8]], object]) -> None:
        time.sleep(0.15)  # the picture follows the hooks
        self._stage.note(name, see(self._desktop.screenshot(self._id)))

    def read_title(self) -> None:
        time.sleep(0.15)
        self._stage.note("title", self._desktop.run("xdotool", "getwindowname", str(self._id)).decode().strip())
