"""The user of the window contract; without a screen, the acts become the script of `Memory`."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

from minirt.mlx import Key, Window

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from minirt.mlx.memory import Memory
    from tests.mlx.stage import Stage

SHIFTED = {"equal": "plus", "slash": "question"}  # of the layout us
KEYS = {"shift": Key.SHIFT_L, "ctrl": Key.CONTROL_L}


class User(ABC):
    """What a user can do with the stage's window."""

    def keys(self, acts: str) -> None:
        """Hold down (+) and let go (-) keys, by their names on the board."""
        for act in acts.split():
            (self.hold if act[0] == "+" else self.let_go)(act[1:])

    @abstractmethod
    def hold(self, key: str) -> None: ...

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
    def resize(self, width: int, height: int) -> None: ...

    @abstractmethod
    def minimise(self) -> None: ...

    @abstractmethod
    def restore(self) -> None: ...

    @abstractmethod
    def close_button(self, window: Window | None = None) -> None: ...

    @abstractmethod
    def wait(self, seconds: float) -> None: ...

    @abstractmethod
    def then(self, action: Callable[[], object]) -> None:
        """Note or prepare something at this moment; calls of MiniLibX belong into hooks."""

    @abstractmethod
    def until(self, condition: Callable[[], bool]) -> None:
        """Wait for what the program does."""

    @abstractmethod
    def await_wake(self) -> None:
        """Wait for another thread's `mlx_wake`."""

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
        if symbol not in KEYS and "ctrl" not in self._held:
            character = chr(_code(symbol)) if _code(symbol) < 0x100 else "\t"
            self._memory.text(character, self._focus)

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

    def resize(self, width: int, height: int) -> None:
        self._memory.resize(width, height, self._stage.win)

    def minimise(self) -> None:
        self._memory.minimise(True, self._stage.win)

    def restore(self) -> None:
        self._memory.minimise(False, self._stage.win)
        self._memory.expose(self._stage.win)

    def close_button(self, window: Window | None = None) -> None:
        self._memory.close_button(window or self._stage.win)

    def wait(self, seconds: float) -> None:
        self._memory.wait(seconds)

    def until(self, condition: Callable[[], bool]) -> None:
        def check() -> None:
            assert condition(), "the program did not do what the user waits for"

        self._memory.do(check)

    def then(self, action: Callable[[], object]) -> None:
        self._memory.do(action)

    def await_wake(self) -> None:
        self._memory.await_wake()

    def look(self, name: str, see: Callable[[NDArray[np.uint8]], object]) -> None:
        self._memory.do(lambda: self._stage.note(name, see(self._memory.screenshot(self._stage.win)[..., 2::-1])))

    def read_title(self) -> None:
        self._memory.do(lambda: self._stage.note("title", self._stage.win.title))


def _code(name: str) -> int:
    return KEYS.get(name) or Key[name.upper()]
