"""MemoryUser: a simulated user of a scenario, whose actions become the script of `Memory`."""

from __future__ import annotations

import sys
import threading
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, TypeAlias

from minirt.mlx import Key, Window
from tests.waiting import until

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import FrameType

    import numpy as np
    from numpy.typing import NDArray

    from minirt.mlx import Mlx
    from minirt.mlx.backend import Display
    from minirt.mlx.memory import Memory
    from tests.mlx.harness import Harness
    from tests.mlx.screen_user import ScreenUser

    User: TypeAlias = "MemoryUser | ScreenUser"  # a scenario does not know which one

SHIFTED_SYMBOLS = {"equal": "plus", "slash": "question", "digit_1": "exclamation"}  # with Shift, on the layout us
KEYS = {"shift": Key.SHIFT_L, "ctrl": Key.CONTROL_L}


class Typist(ABC):
    """Actions that both users of a scenario share."""

    def keys(self, actions: str) -> None:
        """Press (+) and release (-) keys, by their names on the keyboard."""
        for action in actions.split():
            (self.press if action[0] == "+" else self.release)(action[1:])

    @abstractmethod
    def press(self, key: str) -> None: ...

    @abstractmethod
    def release(self, key: str) -> None: ...


class MemoryUser(Typist):
    """A user whose actions at the harness's window, and waits for their effects, become the script of `Memory`."""

    def __init__(self, harness: Harness, memory: Memory) -> None:
        self._harness, self._memory = harness, memory
        self._held: list[str] = []
        self._focus = harness.win
        self._inside = False

    def press(self, key: str) -> None:
        self._held.append(key)
        symbol = SHIFTED_SYMBOLS.get(key, key) if "shift" in self._held else key
        self._memory.press(_code(self._reported(key)), self._focus)
        self._type(symbol)

    def hold_until(self, key: str, enough: Callable[[], bool]) -> None:
        """Hold a key down, which the platform repeats, until `enough` is true. The key stays down."""
        self.press(key)
        for _ in range(10):
            self._memory.wait(0.1)
            self._type(key)
        self.until(enough)

    def release(self, key: str) -> None:
        self._held.remove(key)
        self._memory.release(_code(self._reported(key)), self._focus)

    def move(self, x: int, y: int) -> None:
        self._memory.motion(x, y, self._harness.win)

    def click(self, x: int, y: int, button: int = 1) -> None:
        if button in (4, 5):
            self._memory.scroll({4: 1, 5: -1}[button], x, y, self._harness.win)
        elif button in (6, 7):
            self._memory.scroll(0, x, y, self._harness.win, right={6: -1, 7: 1}[button])
        else:
            self._memory.click(x, y, button, self._harness.win)

    def drop(self, *files: str) -> None:
        self._memory.drop(*files, window=self._harness.win)

    def enter(self) -> None:
        self._inside = True
        self._memory.enter(True, self._harness.win)

    def leave(self) -> None:
        if self._inside:
            self._inside = False
            self._memory.enter(False, self._harness.win)

    def focus(self, window: Window) -> None:
        self._memory.focus(False, self._focus)
        self._memory.focus(True, window)
        self._focus = window

    def press_to_replace_window(self, key: str) -> None:
        """Press and release a key: windows are never replaced here."""
        self.keys(f"+{key} -{key}")

    def resize(self, width: int, height: int) -> None:
        self._memory.resize(width, height, self._harness.win)

    def minimise(self) -> None:
        self._memory.minimise(True, self._harness.win)

    def restore(self) -> None:
        self._memory.minimise(False, self._harness.win)
        self._memory.expose(self._harness.win)

    def close_button(self, window: Window | None = None) -> None:
        self._memory.close_button(window or self._harness.win)

    def until(self, condition: Callable[[], bool]) -> None:
        """Wait for the effect of an action; simulated time stands still."""

        def check() -> None:
            assert condition(), "the effect did not come"

        self._memory.do(check)

    def do(self, action: Callable[[], object]) -> None:
        """Call a function at this point; calls of MiniLibX belong into hooks."""
        self._memory.do(action)

    def wait_until(self, condition: Callable[[], bool], seconds: float) -> None:
        """Wait for an effect that takes time: this many simulated seconds."""
        self._memory.wait(seconds)
        self.until(condition)

    def wait_until_handled(self) -> None:
        """Do nothing: each step waits for the effects of the step before."""

    def wait_until_asleep(self, seconds: float) -> None:
        """Wait until the loop sleeps, or for this many simulated seconds."""
        self._memory.wait(seconds)

    def wake(self) -> None:
        """Call `mlx_wake` from another thread when the loop sleeps."""
        self._memory.do(wake_thread(self._harness.m, self._harness.mlx).start)
        self._memory.await_wake()

    def log_picture(self, name: str, read: Callable[[NDArray[np.uint8]], object]) -> None:
        """Log the value of `read` for the picture that the window shows: (h, w, 3), red first."""
        self._memory.do(
            lambda: self._harness.record(name, read(self._memory.screenshot(self._harness.win)[..., 2::-1]))
        )

    def log_title(self) -> None:
        self._memory.do(lambda: self._harness.record("title", self._harness.win.title))

    def _reported(self, key: str) -> str:
        """Return the name of what the platform reports for a key: its symbol, if the program asked for symbols."""
        symbols = self._harness.win.display.options.symbols and "shift" in self._held
        return SHIFTED_SYMBOLS.get(key, key) if symbols else key

    def _type(self, symbol: str) -> None:
        """Type the character of a key, if it prints one."""
        if symbol not in KEYS and "ctrl" not in self._held:
            character = chr(_code(symbol)) if _code(symbol) < 0x100 else "\t"
            self._memory.text(character, self._focus)


def _code(name: str) -> int:
    """Key code of a name."""
    return KEYS.get(name) or Key[name.upper()]


def wake_thread(m: Mlx, mlx: Display) -> threading.Thread:
    """Make a thread that calls `mlx_wake` as soon as the script in the main thread waits for it."""

    def wake() -> None:
        until(_main_thread_waits, "the step of the script that waits for mlx_wake")
        m.mlx_wake(mlx)

    return threading.Thread(target=wake)


def _main_thread_waits() -> bool:
    """Whether the main thread is in the wait of `Memory._await_wake`."""
    frame: FrameType | None = sys._current_frames()[threading.main_thread().ident or 0]
    names = []
    while frame is not None:
        names.append(frame.f_code.co_name)
        frame = frame.f_back
    return "_await_wake" in names and names[0] == "wait"
