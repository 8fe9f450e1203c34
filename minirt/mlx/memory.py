"""Memory: the back end without a screen. Pictures are read back, events come from a script, time is simulated.

    memory = Memory()
    m = Mlx(backend=memory)
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
import sys
import threading
import time
from collections import deque
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from minirt.errors import MlxError
from minirt.mlx.backend import TICK, Backend
from minirt.mlx.canvas import stretch
from minirt.mlx.events import Button, Event

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from minirt.mlx.backend import Display
    from minirt.mlx.window import Window


class Memory(Backend):
    """A scripted user and a simulated screen.

    screen: width and height in pixels.
    patience: real seconds after the end of the script in which the program has to end, or MlxError is raised.

    The methods of the script take the target window; None is the selected one, at first the oldest, of those that are
    open when the step is played.
    """

    def __init__(self, screen: tuple[int, int] = (2560, 1600), patience: float = 30.0) -> None:
        self.screen = screen
        self.patience = patience
        self.pointer_shown = True
        self.after_tick: Callable[[], object] = lambda: None  # called after each step of simulated time
        self._script: deque[Callable[[], object]] = deque()
        self._display: Display | None = None
        self._wakeup = threading.Event()
        self._now = 0.0
        self._screens: dict[Window, NDArray[np.uint8]] = {}
        self._sizes: dict[Window, tuple[int, int]] = {}  # of the frame buffers
        self._windowed: dict[Window, tuple[int, int]] = {}  # sizes of full-screen windows before
        self._selected = 0  # number of the window that steps without a window act on
        self._last: NDArray[np.uint8] | None = None  # the picture that was shown last, in any window

    # --- the script: steps of the user, in this order ---

    def press(self, key: int, window: Window | None = None) -> None:
        """Hold a key down; a modifier is a key like any other."""
        self.do(lambda: self._target(window).keyboard.press(key, self._now))

    def release(self, key: int, window: Window | None = None) -> None:
        """Let a key go."""
        self.do(lambda: self._target(window).keyboard.release(key))

    def tap(self, *keys: int, window: Window | None = None) -> None:
        """Press the keys in this order and release them in the opposite one: tap(Key.CONTROL_L, Key.Z)."""
        for key in keys:
            self.press(key, window)
        for key in reversed(keys):
            self.release(key, window)

    def text(self, text: str, window: Window | None = None) -> None:
        """Type text, without presses of keys."""
        self.do(lambda: self._target(window).on_text(text))

    def button_press(self, button: int, x: int, y: int, window: Window | None = None) -> None:
        self.do(lambda: self._target(window).on_button(Event.BUTTON_PRESS, button, x, y))

    def button_release(self, button: int, x: int, y: int, window: Window | None = None) -> None:
        self.do(lambda: self._target(window).on_button(Event.BUTTON_RELEASE, button, x, y))

    def click(self, x: int, y: int, button: int = Button.LEFT, window: Window | None = None) -> None:
        self.button_press(button, x, y, window)
        self.button_release(button, x, y, window)

    def motion(self, x: int, y: int, window: Window | None = None) -> None:
        self.do(lambda: self._target(window).on_motion(x, y))

    def scroll(self, up: int, x: int, y: int, window: Window | None = None, right: int = 0) -> None:
        """Turn the wheel by a number of steps; negative steps go down and left."""
        self.do(lambda: self._target(window).on_scroll(right, up, x, y))

    def drop(self, *files: str, window: Window | None = None) -> None:
        """Drop files on the window."""
        self.do(lambda: self._target(window).on_drop(files))

    def enter(self, inside: bool, window: Window | None = None) -> None:
        """Move the pointer into the window, or out of it."""
        self.do(lambda: self._target(window).deliver(Event.ENTER_NOTIFY if inside else Event.LEAVE_NOTIFY))

    def focus(self, focused: bool, window: Window | None = None) -> None:
        self.do(lambda: self._target(window).on_focus(focused))

    def resize(self, width: int, height: int, window: Window | None = None) -> None:
        self.do(lambda: self._resize(self._target(window), width, height))

    def minimise(self, hidden: bool, window: Window | None = None) -> None:
        """Hide the window, or bring it back."""
        self.do(lambda: self._target(window).on_visibility(not hidden))

    def expose(self, window: Window | None = None) -> None:
        self.do(lambda: self._target(window).on_expose())

    def close_button(self, window: Window | None = None) -> None:
        self.do(lambda: self._target(window).on_close_button())

    def wait(self, seconds: float) -> None:
        """Advance simulated time, in ticks of at most TICK seconds."""
        self.do(lambda: self._advance(seconds))

    def await_wake(self) -> None:
        """Wait, in real time, until `mlx_wake` is called."""
        self.do(self._await_wake)

    def select(self, number: int) -> None:
        """Let the next steps act on another window, 0 for the oldest."""
        self.do(partial(setattr, self, "_selected", number))

    def save(self, file: Path) -> None:
        """Save the picture of the selected window or, if it is closed, the one that was shown last. MlxError."""
        self.do(partial(self._save, file))

    def do(self, action: Callable[[], object]) -> None:
        """Add any other step, for example to check a picture half way. May be called from any thread."""
        self._script.append(action)
        self._wakeup.set()

    # --- playing the script ---

    def play(self) -> None:
        """Play the script to its end, without `mlx_loop`. Raises the exception of a hook.

        Each step starts when the program has nothing left to do after the step before."""
        self._settle()
        while self._script and not self.display.over:
            self._script.popleft()()
            self._settle()
        self.display.raise_failure()

    def run(self) -> None:
        deadline = time.monotonic() + self.patience
        self.display.turn(tick=False)
        while not self.display.over:
            if self._script:
                self._script.popleft()()
                self.display.turn(tick=False)
                deadline = time.monotonic() + self.patience
            elif time.monotonic() > deadline:
                raise MlxError(f"the script is over and the program did not end within {self.patience} s")
            elif self.display.busy:
                self._advance(TICK)
            elif self._wakeup.wait(max(0.0, deadline - time.monotonic())):
                self._wakeup.clear()
                self.display.turn(tick=False)
        self._script.clear()  # steps after the end of the loop are dropped

    def screenshot(self, window: Window | None = None) -> NDArray[np.uint8]:
        """Return the picture that the window shows now: (h, w, 4) uint8, BGRA."""
        return self._screens[self._target(window)].copy()

    @property
    def display(self) -> Display:
        """The display that `mlx_init` opened."""
        assert self._display is not None, "mlx_init was not called"
        return self._display

    @property
    def windows(self) -> list[Window]:
        """The open windows, oldest first."""
        return list(self.display.windows)

    def _target(self, window: Window | None) -> Window:
        if window is not None:
            return window
        windows = self.display.windows
        if self._selected >= len(windows):
            raise MlxError(f"there is no window {self._selected + 1}: {len(windows)} are open")
        return windows[self._selected]

    def _settle(self) -> None:
        """Take turns until no hook calls `mlx_wake`."""
        self.display.turn(tick=False)
        while self.display.woken and not self.display.over:
            self.display.turn(tick=False)

    def _advance(self, seconds: float) -> None:
        """Advance simulated time, in ticks of at most TICK seconds."""
        ticks = max(1, math.ceil(seconds / TICK - 1e-9))
        for _ in range(ticks):
            if not self.display.over:
                self._now += seconds / ticks
                self.display.turn(tick=True)
                self.after_tick()

    def _await_wake(self) -> None:
        deadline = time.monotonic() + self.patience
        while not self.display.woken:
            if not self._wakeup.wait(max(0.0, deadline - time.monotonic())):
                raise MlxError(f"mlx_wake was not called within {self.patience} s")
            self._wakeup.clear()

    def _resize(self, window: Window, width: int, height: int) -> None:
        self._sizes[window] = width, height
        window.on_resize(width, height)

    def _save(self, file: Path) -> None:
        from PIL import Image

        windows = self.windows if self._display else []
        pixels = self._screens[windows[self._selected]] if self._selected < len(windows) else self._last
        if pixels is None:
            raise MlxError("there is no picture: no window was opened")
        try:
            Image.fromarray(pixels[..., 2::-1]).save(file)
        except (OSError, ValueError) as error:
            raise MlxError(f"{file} cannot be written: {error}") from error

    # --- the rest of the contract of a back end ---

    def open(self, display: Display) -> None:
        self._display = display

    def close(self) -> None:
        self._screens.clear()

    def open_window(self, window: Window) -> None:
        self._sizes[window] = window.width, window.height

    def close_window(self, window: Window) -> None:
        self._screens.pop(window, None)

    def show(self, window: Window) -> None:
        window.shown.take_changes()
        self._screens[window] = self._last = stretch(window.shown.pixels, *self._sizes[window])

    def wake(self) -> None:
        self._wakeup.set()

    def time(self) -> float:
        return self._now

    def screen_size(self) -> tuple[int, int]:
        return self.screen

    def set_fullscreen(self, window: Window, on: bool) -> None:
        if on:
            self._windowed.setdefault(window, self._sizes[window])
            self._resize(window, *self.screen)
        elif window in self._windowed:
            self._resize(window, *self._windowed.pop(window))

    def move_pointer(self, window: Window, x: int, y: int) -> None:
        """Report the motion before the next step of the script."""
        self._script.appendleft(lambda: window.on_motion(x, y))
        self._wakeup.set()

    def show_pointer(self, window: Window, on: bool) -> None:
        self.pointer_shown = on


class Headless(Memory):
    """A user who leaves a tick of the loop between two steps, and clicks the close button at the end.

    picture: the file of the last picture, or None.
    """

    def __init__(self, picture: Path | None, screen: tuple[int, int]) -> None:
        super().__init__(screen)
        self.picture = picture

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
                self._save(self.picture)
        except MlxError as error:
            print(f"mlx: {error}", file=sys.stderr)
            return False
        return True

    def pass_time(self, seconds: float) -> None:
        """Let simulated time pass, without turns of the loop."""
        self._now += seconds

    def _pause(self) -> None:
        """Let the program handle what came, and take one tick of the loop."""
        self.display.turn(tick=False)
        self._advance(TICK)
