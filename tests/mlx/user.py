"""The user of the window contract; without a screen, the acts become the script of `Memory`."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

from minirt.mlx import Key, Window
from tests.mlx.waker import waker

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from minirt.mlx.memory import Memory
    from tests.mlx.stage import Stage

SHIFTED = {"equal": "plus", "slash": "question"}  # of the layout us
KEYS = {"shift": Key.SHIFT_L, "ctrl": Key.CONTROL_L}


class User(ABC):
    """The acts of a user at the stage's window, and waits for the program."""

    def keys(self, acts: str) -> None:
        """Hold down (+) and let go (-) keys, by their names on the board."""
        for act in acts.split():
            (self.hold if act[0] == "+" else self.let_go)(act[1:])

    @abstractmethod
    def hold(self, key: str) -> None: ...

    @abstractmethod
    def hold_until(self, key: str, enough: Callable[[], bool]) -> None:
        """Hold a key down, which the platform types again and again, until `enough`."""

    @abstractmethod
    def let_go(self, key: str) -> None: ...

    @abstractmethod
    def move(self, x: int, y: int) -> None: ...

    @abstractmethod
    def click(self, x: int, y: int, button: int = 1) -> None: ...

    @abstractmethod
    def drop(self, *files: str) -> None:
        """Drag files from elsewhere to the window and let them go."""

    @abstractmethod
    def enter(self) -> None: ...

    @abstractmethod
    def leave(self) -> None: ...

    @abstractmethod
    def focus(self, window: Window) -> None: ...

    @abstractmethod
    def press_for_another_window(self, key: str) -> None:
        """Press a key that makes another window of the window system instead of the stage's, and let it go.

        It is let go when the old window is not there any more, and the new one has not got the focus yet.
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
    def then(self, action: Callable[[], object]) -> None:
        """Note or prepare something at this moment; calls of MiniLibX belong into hooks."""

    @abstractmethod
    def until(self, condition: Callable[[], bool]) -> None:
        """Wait for what the program does about what the user did; no time goes by where time is simulated."""

    @abstractmethod
    def wait_until(self, condition: Callable[[], bool], seconds: float) -> None:
        """Wait for what the program does as time goes by: so many seconds where time is simulated."""

    @abstractmethod
    def settle(self) -> None:
        """Wait until the program has handled all that the user did."""

    @abstractmethod
    def rest(self, seconds: float) -> None:
        """Wait until the loop sleeps; let so many seconds go by where time is simulated."""

    @abstractmethod
    def wake(self) -> None:
        """Let another thread call `mlx_wake` when the loop sleeps."""

    @abstractmethod
    def look(self, name: str, see: Callable[[NDArray[np.uint8]], object]) -> None:
        """Log what `see` says of the picture (h, w, 3), red first, that the window shows."""

    @abstractmethod
    def read_title(self) -> None:
        """Log the title."""


class MemoryUser(User):
    def __init__(self, stage: Stage, memory: Memory) -> None:
        self._stage, self._memory = stage, memory
        self._held: list[str] = []
        self._focus = stage.win
        self._inside = False

    def hold(self, key: str) -> None:
        self._held.append(key)
        symbol = SHIFTED.get(key, key) if "shift" in self._held else key
        self._memory.press(_code(symbol), self._focus)
        self._type(symbol)

    def hold_until(self, key: str, enough: Callable[[], bool]) -> None:
        self.hold(key)
        for _ in range(10):
            self._memory.wait(0.1)
            self._type(key)
        self.until(enough)

    def let_go(self, key: str) -> None:
        self._held.remove(key)
        self._memory.release(_code(SHIFTED.get(key, key) if "shift" in self._held else key), self._focus)

    def move(self, x: int, y: int) -> None:
        self._memory.motion(x, y, self._stage.win)

    def click(self, x: int, y: int, button: int = 1) -> None:
        if button in (4, 5):
            self._memory.scroll({4: 1, 5: -1}[button], x, y, self._stage.win)
        elif button in (6, 7):
            self._memory.scroll(0, x, y, self._stage.win, right={6: -1, 7: 1}[button])
        else:
            self._memory.click(x, y, button, self._stage.win)

    def drop(self, *files: str) -> None:
        self._memory.drop(*files, window=self._stage.win)

    def enter(self) -> None:
        self._inside = True
        self._memory.enter(True, self._stage.win)

    def leave(self) -> None:
        if self._inside:
            self._inside = False
            self._memory.enter(False, self._stage.win)

    def focus(self, window: Window) -> None:
        self._memory.focus(False, self._focus)
        self._memory.focus(True, window)
        self._focus = window

    def press_for_another_window(self, key: str) -> None:
        """Windows are never made anew here."""
        self.keys(f"+{key} -{key}")

    def resize(self, width: int, height: int) -> None:
        self._memory.resize(width, height, self._stage.win)

    def minimise(self) -> None:
        self._memory.minimise(True, self._stage.win)

    def restore(self) -> None:
        self._memory.minimise(False, self._stage.win)
        self._memory.expose(self._stage.win)

    def close_button(self, window: Window | None = None) -> None:
        self._memory.close_button(window or self._stage.win)

    def until(self, condition: Callable[[], bool]) -> None:
        def check() -> None:
            assert condition(), "the program did not do what the user waits for"

        self._memory.do(check)

    def then(self, action: Callable[[], object]) -> None:
        self._memory.do(action)

    def wait_until(self, condition: Callable[[], bool], seconds: float) -> None:
        self._memory.wait(seconds)
        self.until(condition)

    def settle(self) -> None:
        """Nothing to do: each step waits for the one before."""

    def rest(self, seconds: float) -> None:
        self._memory.wait(seconds)

    def wake(self) -> None:
        self._memory.do(waker(self._stage.m, self._stage.mlx).start)
        self._memory.await_wake()

    def look(self, name: str, see: Callable[[NDArray[np.uint8]], object]) -> None:
        self._memory.do(lambda: self._stage.note(name, see(self._memory.screenshot(self._stage.win)[..., 2::-1])))

    def read_title(self) -> None:
        self._memory.do(lambda: self._stage.note("title", self._stage.win.title))

    def _type(self, symbol: str) -> None:
        """Text comes with a key that prints something."""
        if symbol not in KEYS and "ctrl" not in self._held:
            character = chr(_code(symbol)) if _code(symbol) < 0x100 else "\t"
            self._memory.text(character, self._focus)


def _code(name: str) -> int:
    return KEYS.get(name) or Key[name.upper()]
