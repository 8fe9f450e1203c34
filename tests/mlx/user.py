"""MemoryUser: a simulated user of a scenario, whose actions become the script of `Memory`."""

from __future__ import annotations

import threading
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, TypeAlias

from minirt.mlx import Event, Key
from tests.waiting import until

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from minirt.mlx import Window
    from minirt.mlx.memory import Memory
    from tests.mlx.contract import Harness
    from tests.mlx.screen_user import ScreenUser

    User: TypeAlias = "MemoryUser | ScreenUser"  # a scenario does not know which one

SHIFTED_SYMBOLS = {"equal": "plus", "slash": "question", "digit_1": "exclamation"}  # with Shift, on the layout us
KEYS = {"shift": Key.SHIFT_L, "ctrl": Key.CONTROL_L}
WHEEL = {4: (0, 1), 5: (0, -1), 6: (-1, 0), 7: (1, 0)}  # steps to the right and up, by the buttons of the wheel


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
        self._win = self._focus = harness.win
        self._held: list[str] = []
        self._inside = False
        self.do = memory.do  # calls a function at this point; calls of MiniLibX belong into hooks

    def press(self, key: str) -> None:
        self._held.append(key)
        code, keyboard = _code(self._reported(key)), self._focus.keyboard
        self.do(lambda: keyboard.press(code, self._memory.time()))
        self._type(SHIFTED_SYMBOLS.get(key, key) if "shift" in self._held else key)

    def hold_until(self, key: str, enough: Callable[[], bool]) -> None:
        """Hold a key down, which the platform repeats, until `enough` is true. The key stays down."""
        self.press(key)
        for _ in range(10):
            self._memory.wait(0.1)
            self._type(key)
        self.until(enough)

    def release(self, key: str) -> None:
        self._held.remove(key)
        code, keyboard = _code(self._reported(key)), self._focus.keyboard
        self.do(lambda: keyboard.release(code))

    def move(self, x: int, y: int) -> None:
        self.do(lambda: self._win.on_motion(x, y))

    def click(self, x: int, y: int, button: int = 1) -> None:
        if button in WHEEL:
            self.do(lambda: self._win.on_scroll(*WHEEL[button], x, y))
        else:
            self._memory.click(x, y, button)

    def drop(self, *files: str) -> None:
        self._memory.drop(*files)

    def enter(self) -> None:
        self._inside = True
        self.do(lambda: self._win.deliver(Event.ENTER_NOTIFY))

    def leave(self) -> None:
        if self._inside:
            self._inside = False
            self.do(lambda: self._win.deliver(Event.LEAVE_NOTIFY))

    def focus(self, window: Window) -> None:
        before, self._focus = self._focus, window
        self.do(lambda: before.on_focus(False))
        self.do(lambda: window.on_focus(True))

    def press_to_replace_window(self, key: str) -> None:
        """Press and release a key: windows are never replaced here."""
        self.keys(f"+{key} -{key}")

    def resize(self, width: int, height: int) -> None:
        self._memory.resize(width, height)

    def minimise(self) -> None:
        self._memory.minimise(True)

    def restore(self) -> None:
        self._memory.minimise(False)
        self.do(self._win.on_expose)

    def close_button(self) -> None:
        self._memory.close_button()

    def until(self, condition: Callable[[], bool]) -> None:
        """Wait for the effect of an action; simulated time stands still."""

        def check() -> None:
            assert condition(), "the effect did not come"

        self.do(check)

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
        """Call `mlx_wake` from another thread."""

        def wake() -> None:
            threading.Thread(target=self._harness.m.mlx_wake, args=(self._memory,)).start()
            until(self._memory.woken.is_set, "mlx_wake")

        self.do(wake)

    def log_picture(self, name: str, read: Callable[[NDArray[np.uint8]], object]) -> None:
        """Log the value of `read` for the picture that the window shows: (h, w, 3), red first."""
        self.do(lambda: self._harness.record(name, read(self._memory.screenshot()[..., 2::-1])))

    def log_title(self) -> None:
        self.do(lambda: self._harness.record("title", self._win.title))

    def _reported(self, key: str) -> str:
        """Return the name of what the platform reports for a key: its symbol, if the program asked for symbols."""
        symbols = self._memory.options.symbols and "shift" in self._held
        return SHIFTED_SYMBOLS.get(key, key) if symbols else key

    def _type(self, symbol: str) -> None:
        """Type the character of a key, if it prints one."""
        if symbol not in KEYS and "ctrl" not in self._held:
            character, window = chr(_code(symbol)) if _code(symbol) < 0x100 else "\t", self._focus
            self.do(lambda: window.on_text(character))


def _code(name: str) -> int:
    """Key code of a name."""
    return KEYS.get(name) or Key[name.upper()]
