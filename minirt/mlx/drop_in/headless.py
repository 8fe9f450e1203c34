"""Headless: the back end of a program that runs without a screen, with a script of events and a picture at the end."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from minirt.errors import MlxError
from minirt.mlx.drop_in.clock import simulate_time
from minirt.mlx.memory import TICK, Memory

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from minirt.mlx.window import Window


class Headless(Memory):
    """A scripted user who leaves a tick of the loop between two steps, and clicks the close button at the end.

    picture: the file of the last picture, or None. `selected`: the number of the window that the steps act on.
    """

    def __init__(self, picture: Path | None, screen: tuple[int, int]) -> None:
        super().__init__(screen)
        self.picture = picture
        self.selected = 0
        self._last: NDArray[np.uint8] | None = None  # the picture that was shown last, in any window

    def simulate_process(self) -> None:
        """Let the program see simulated time, and save its picture even if it ends by `os._exit`."""
        leave = os._exit

        def save_and_leave(status: int) -> None:
            leave(status if self.finish() else 1)

        simulate_time(self.time, self._pass_time)
        os._exit = save_and_leave  # type: ignore[assignment]

    def run(self) -> None:
        """Play the script; then save the picture, click the close button, and end the loop if that did not."""
        self._pause()
        while self._script and not self.display.over:
            self._script.popleft()()
            self._pause()
        if not self.display.over:
            self.finish()
            self.picture = None  # what the program draws when it ends does not count
            self._target(None).on_close_button()
            self.display.turn(tick=False)

    def finish(self) -> bool:
        """Save the last picture, if one is asked for. False if that failed; the reason is printed."""
        try:
            if self.picture:
                self.save(self.picture)
        except MlxError as error:
            print(f"mlx: {error}", file=sys.stderr)
            return False
        return True

    def save(self, file: Path) -> None:
        """Save the picture of the selected window or, if it is closed, the one that was shown last. Raises MlxError."""
        from PIL import Image

        windows = self.windows if self._display else []
        pixels = self.screenshot(windows[self.selected]) if self.selected < len(windows) else self._last
        if pixels is None:
            raise MlxError("there is no picture: no window was opened")
        try:
            Image.fromarray(pixels[..., 2::-1]).save(file)
        except (OSError, ValueError) as error:
            raise MlxError(f"{file} cannot be written: {error}") from error

    def show(self, window: Window) -> None:
        super().show(window)
        self._last = self.screenshot(window)

    def _pause(self) -> None:
        """Let the program handle what came, and take one tick of the loop."""
        self.display.turn(tick=False)
        self._advance(TICK)

    def _pass_time(self, seconds: float) -> None:
        self._now += seconds

    def _target(self, window: Window | None) -> Window:
        if window is not None:
            return window
        windows = self.windows
        if self.selected >= len(windows):
            raise MlxError(f"there is no window {self.selected + 1}: {len(windows)} are open")
        return windows[self.selected]
