"""User: a simulated user of a scenario, and MemoryUser, whose actions become the script of `Memory`."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

from minirt.mlx import Key, Window
from tests.mlx.wake_thread import wake_thread

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from minirt.mlx.memory import Memory
    from tests.mlx.harness import Harness

SHIFTED_SYMBOLS = {"equal": "plus", "slash": "question", "digit_1": "exclamation"}  # with Shift, on the layout us
KEYS = {"shift": Key.SHIFT_L, "ctrl": Key.CONTROL_L}


class User(ABC):
    """Actions of a user at the harness's window, and waits for their effects."""

    def keys(self, actions: str) -> None:
        """Press (+) and release (-) keys, by their names on the keyboard."""
        for action in actions.split():
            (self.press if action[0] == "+" else self.release)(action[1:])

    @abstractmethod
    def press(self, key: str) -> None: ...

    @abstractmethod
    def hold_until(self, key: str, enough: Callable[[], bool]) -> None:
        """Hold a key down, which the platform repeats, until `enough` is true. The key stays down."""

    @abstractmethod
    def release(self, key: str) -> None: ...

    @abstractmethod
    def move(self, x: int, y: int) -> None: ...

    @abstractmethod
    def click(self, x: int, y: int, button: int = 1) -> None: ...

    @abstractmethod
    def drop(self, *files: str) -> None:
        """Drag files to the window and drop them."""

    @abstractmethod
    def enter(self) -> None: ...

    @abstractmethod
    def leave(self) -> None: ...

    @abstractmethod
    def focus(self, window: Window) -> None: ...

    @abstractmethod
    def press_to_replace_window(self, key: str) -> None:
        """Press and release a key that makes the window system replace the harness's window by a new one.

        It is released when the old window is gone and the new one does not have the focus yet.
        """

    @abstractmethod
    def resize(self, width: int, height: int) -> None: ...

    @abstractmethod
    def minimise(self) -> None: ...

    @abstractmethod
    def restore(self) -> None: ...

    @abstractmethod
    def close_button(self, window: Window | None = None) -> None: ...

    @abstractmethod
    def do(self, action: Callable[[], object]) -> None:
        """Call a function at this point; calls of MiniLibX belong into hooks."""

    @abstractmethod
    def until(self, condition: Callable[[], bool]) -> None:
        """Wait for the effect of an action; simulated time stands still."""

    @abstractmethod
    def wait_until(self, condition: Callable[[], bool], seconds: float) -> None:
        """Wait for an effect that takes time: this many simulated seconds."""

    @abstractmethod
    def wait_until_handled(self) -> None:
        """Wait until the program has handled all actions."""

    @abstractmethod
    def wait_until_asleep(self, seconds: float) -> None:
        """Wait until the loop sleeps, or for this many simulated seconds."""

    @abstractmethod
    def wake(self) -> None:
        """Call `mlx_wake` from another thread when the loop sleeps."""

    @abstractmethod
    def log_picture(self, name: str, read: Callable[[NDArray[np.uint8]], object]) -> None:
        """Log the value of `read` for the picture that the window shows: (h, w, 3), red first."""

    @abstractmethod
    def log_title(self) -> None:
        """Log the title of the window."""


class MemoryUser(User):
    """A user whose actions become the script of `Memory`."""

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
        def check() -> None:
            assert condition(), "the effect did not come"

        self._memory.do(check)

    def do(self, action: Callable[[], object]) -> None:
        self._memory.do(action)

    def wait_until(self, condition: Callable[[], bool], seconds: float) -> None:
        self._memory.wait(seconds)
        self.until(condition)

    def wait_until_handled(self) -> None:
        """Do nothing: each step waits for the effects of the step before."""

    def wait_until_asleep(self, seconds: float) -> None:
        self._memory.wait(seconds)

    def wake(self) -> None:
        self._memory.do(wake_thread(self._harness.m, self._harness.mlx).start)
        self._memory.await_wake()

    def log_picture(self, name: str, read: Callable[[NDArray[np.uint8]], object]) -> None:
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
