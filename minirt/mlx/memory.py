"""Memory: the back end without a screen. Pictures are read back, events come from a script, time is simulated.

    memory = Memory()
    m = Mlx(memory)
    mlx = m.mlx_init()
    ...                                   # windows, hooks
    memory.press(Key.W)                   # each call adds a step to the script
    memory.wait(0.5)
    memory.release(Key.W)
    memory.play()                         # or m.mlx_loop(mlx), which plays the script and goes on
    picture = memory.screenshot()

The script is a list of steps of a user. Between two steps the program's loop takes a turn.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from minirt.errors import MlxError
from minirt.mlx.canvas import stretch
from minirt.mlx.display import TICK, Display
from minirt.mlx.events import Button, Event
from minirt.mlx.window import Window


class MemoryWindow(Window):
    """A window whose screen is an array. `picture`: what it shows, (h, w, 4) uint8, BGRA."""

    display: Memory
    picture: NDArray[np.uint8]

    def __post_init__(self) -> None:
        super().__post_init__()
        self._size = self.width, self.height  # of the frame buffer
        self._windowed: tuple[int, int] | None = None  # the size before full screen

    def blit(self) -> None:
        self.shown.take_changes()
        self.picture = self.display.last = stretch(self.shown.pixels, *self._size)

    def resize(self, width: int, height: int) -> None:
        self._size = width, height
        self.on_resize(width, height)

    def set_fullscreen(self, on: bool) -> None:
        if on:
            self._windowed = self._windowed or self._size
            self.resize(*self.display.screen)
        elif self._windowed:
            self.resize(*self._windowed)
            self._windowed = None

    def move_pointer(self, x: int, y: int) -> None:
        """Report the motion before the next step of the script."""
        self.display.actions.appendleft(lambda: self.on_motion(x, y))
        self.display.wake_up()


class Memory(Display):
    """A scripted user and a simulated screen. The steps of the script act on the selected window, at first the oldest.

    screen: width and height in pixels.
    patience: real seconds after the end of the script in which the program has to end, or MlxError is raised.
    """

    window_type = MemoryWindow
    windows: list[MemoryWindow]  # type: ignore[assignment]

    def __init__(self, screen: tuple[int, int] = (2560, 1600), patience: float = 30.0) -> None:
        super().__init__()
        self.screen = screen
        self.patience = patience
        self.after_tick: Callable[[], object] = lambda: None  # called after each step of simulated time
        self.last: NDArray[np.uint8] | None = None  # the picture that was shown last, in any window
        self._now = 0.0
        self.selected = 0  # number of the window that steps act on

    # --- the script: steps of the user, in this order; `do` adds any other, for example to check a picture half way ---

    def press(self, *keys: int) -> None:
        """Hold keys down, one after the other; a modifier is a key like any other."""
        for key in keys:
            self.do(lambda key=key: self.window.keyboard.press(key, self._now))  # type: ignore[misc]

    def release(self, *keys: int) -> None:
        """Let keys go, one after the other."""
        for key in keys:
            self.do(lambda key=key: self.window.keyboard.release(key))  # type: ignore[misc]

    def tap(self, *keys: int) -> None:
        """Press the keys in this order and release them in the opposite one: tap(Key.CONTROL_L, Key.Z)."""
        self.press(*keys)
        self.release(*reversed(keys))

    def text(self, text: str) -> None:
        """Type text, without presses of keys."""
        self.do(lambda: self.window.on_text(text))

    def button_press(self, button: int, x: int, y: int) -> None:
        self.do(lambda: self.window.on_button(Event.BUTTON_PRESS, button, x, y))

    def button_release(self, button: int, x: int, y: int) -> None:
        self.do(lambda: self.window.on_button(Event.BUTTON_RELEASE, button, x, y))

    def click(self, x: int, y: int, button: int = Button.LEFT) -> None:
        self.button_press(button, x, y)
        self.button_release(button, x, y)

    def motion(self, x: int, y: int) -> None:
        self.do(lambda: self.window.on_motion(x, y))

    def scroll(self, up: int, *place: int) -> None:
        """Turn the wheel by a number of steps, at a place x, y or where the pointer is; negative steps go down."""
        self.do(lambda: self.window.on_scroll(0, up, *(place or self.window.pointer)))

    def drop(self, *files: str) -> None:
        self.do(lambda: self.window.on_drop(files))

    def resize(self, width: int, height: int) -> None:
        self.do(lambda: self.window.resize(width, height))

    def minimise(self, hidden: bool) -> None:
        """Hide the window, or bring it back."""
        self.do(lambda: self.window.on_visibility(not hidden))

    def close_button(self) -> None:
        self.do(lambda: self.window.on_close_button())  # noqa: PLW0108  (the window of then)

    def wait(self, seconds: float) -> None:
        """Advance simulated time, in ticks of at most TICK seconds."""
        self.do(lambda: self._advance(seconds))

    # --- playing the script ---

    def play(self) -> None:
        """Play the script to its end, without `mlx_loop`. Raises the exception of a hook.

        Each step starts when the program has nothing left to do after the step before."""
        self._settle()
        while self.actions and not self.over:
            self.actions.popleft()()
            self._settle()
        self.raise_failure()

    def run(self) -> None:
        """Play the script, and go on until the program ends; MlxError if that takes more than `patience` seconds.

        After the script simulated time goes on while the program is busy. Otherwise it stands still until `wake_up`.
        """
        deadline = time.monotonic() + self.patience
        self.turn(tick=False)
        while not self.over:
            if self.actions:
                self.actions.popleft()()
                self.turn(tick=False)
                deadline = time.monotonic() + self.patience
            elif time.monotonic() > deadline:
                raise MlxError(f"the script is over and the program did not end within {self.patience} s")
            elif self.busy:
                self._advance(TICK)
            elif self.awake.wait(max(0.0, deadline - time.monotonic())):
                self.awake.clear()
                self.turn(tick=False)
        self.actions.clear()  # steps after the end of the loop are dropped

    @property
    def window(self) -> MemoryWindow:
        """The selected window. Raises MlxError."""
        if self.selected >= len(self.windows):
            raise MlxError(f"there is no window {self.selected + 1}: {len(self.windows)} are open")
        return self.windows[self.selected]

    def screenshot(self) -> NDArray[np.uint8]:
        """Return the picture that the selected window shows now: (h, w, 4) uint8, BGRA."""
        return self.window.picture.copy()

    def _settle(self) -> None:
        """Take turns until no hook calls `mlx_wake`."""
        self.turn(tick=False)
        while self.woken.is_set() and not self.over:
            self.turn(tick=False)

    def _advance(self, seconds: float) -> None:
        ticks = max(1, math.ceil(seconds / TICK - 1e-9))
        for _ in range(ticks):
            if not self.over:
                self._now += seconds / ticks
                self.turn(tick=True)
                self.after_tick()

    def save(self, file: Path) -> None:
        """Save the picture of the selected window or, if it is closed, the one that was shown last. MlxError."""
        from PIL import Image

        pixels = self.window.picture if self.selected < len(self.windows) else self.last
        if pixels is None:
            raise MlxError("there is no picture: no window was opened")
        try:
            Image.fromarray(pixels[..., 2::-1]).save(file)
        except (OSError, ValueError) as error:
            raise MlxError(f"{file} cannot be written: {error}") from error

    # --- the rest of the contract of a back end ---

    def time(self) -> float:
        return self._now

    def screen_size(self) -> tuple[int, int]:
        return self.screen
