"""Harness: the environment in which a scenario of the contract runs.

A scenario sets hooks that write to `Harness.log`, then calls `Harness.run` with the actions of a user. Without a screen
the actions become the script of `Memory`; on a screen a second thread performs them while the loop runs.
"""

from __future__ import annotations

from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

from minirt.mlx import Mlx, Window
from minirt.mlx.memory import Memory
from tests.mlx.screen_user import ScreenUser
from tests.mlx.user import MemoryUser

if TYPE_CHECKING:
    from collections.abc import Callable

    from tests.mlx.user import User


class Harness:
    """A window `win` of 200x100 pixels, a log, and the log that is expected of the scenario.

    Exceptions of hooks are raised, or failed assertions would be lost.
    """

    def __init__(self, m: Mlx, title: str, expected: list[list[Any]]) -> None:
        m.mlx_set_options(strict=True, symbols=False)
        self.m = m
        self.mlx = m.mlx_init()
        self.expected = expected
        self.undo = ExitStack()  # of what a scenario has changed for all programs
        self.log: list[list[Any]] = []
        self.win = m.mlx_new_window(self.mlx, 200, 100, title, resizable=True)

    @property
    def has_diverged(self) -> bool:
        """Whether the log differs from the beginning of the expected log."""
        return self.log != self.expected[: len(self.log)]

    def record(self, *entry: object) -> None:
        """Append an entry to the log."""
        self.log.append(list(entry))

    def hook(self, event: int, name: str, win: Window | None = None) -> None:
        """Record an event under a name, with all arguments of its hook."""
        self.m.mlx_hook(win or self.win, event, 0, lambda *arguments: self.record(arguments[-1], *arguments[:-1]), name)

    def run(self, actions: Callable[[User], object]) -> None:
        """Run the loop while a user performs the actions, then end the loop."""
        memory = self.mlx
        with self.undo:
            if isinstance(memory, Memory):
                actions(MemoryUser(self, memory))
                memory.do(lambda: self.m.mlx_loop_exit(self.mlx))
                self.m.mlx_loop(self.mlx)
            else:
                ScreenUser(self).run(actions)
