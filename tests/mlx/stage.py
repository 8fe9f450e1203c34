"""A stage for programs of the window contract.

A scenario sets hooks that write to `Stage.log`, then calls `Stage.play` with what the user does. Without a screen the
user's acts are the script of `Memory`; on a screen a second thread plays them while the loop runs.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from minirt.mlx import Mlx, Window
from minirt.mlx.memory import Memory
from tests.mlx.screen_user import ScreenUser
from tests.mlx.user import MemoryUser, User

if TYPE_CHECKING:
    from collections.abc import Callable


class Stage:
    """One window called `win`, 200x100; `expected` is the log that the scenario must leave."""

    def __init__(self, m: Mlx, title: str, expected: list[list[Any]]) -> None:
        self.m = m
        self.mlx = m.mlx_init()
        self.expected = expected
        self.log: list[list[Any]] = []
        self.win = m.mlx_new_window(self.mlx, 200, 100, title, resizable=True)

    @property
    def astray(self) -> bool:
        """Whether the log has something that it must not have there."""
        return self.log != self.expected[: len(self.log)]

    def note(self, *what: object) -> None:
        self.log.append(list(what))

    def hook(self, event: int, name: str, win: Window | None = None) -> None:
        """Log the event with all that the hook receives; the parameter is the name."""
        self.m.mlx_hook(win or self.win, event, 0, lambda *got: self.note(got[-1], *got[:-1]), name)

    def play(self, acts: Callable[[User], object]) -> None:
        """The user acts while the loop runs; then the loop is ended."""
        backend = self.mlx.backend
        if isinstance(backend, Memory):
            acts(MemoryUser(self, backend))
            backend.do(lambda: self.m.mlx_loop_exit(self.mlx))
            self.m.mlx_loop(self.mlx)
        else:
            ScreenUser(self).play(acts)
