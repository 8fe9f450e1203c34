"""The contract of back ends as scenarios: small programs with known logs.

A scenario sets hooks that write to `Harness.log`, then calls `Harness.run` with the actions of a user. Without a screen
the actions become the script of `Memory`; on a screen a second thread performs them while the loop runs.

`test_contract` runs each scenario on both back ends and expects the same log. Run as a module, this file runs all
scenarios on the screen, and writes the log of each as a line of JSON.
"""

from __future__ import annotations

import faulthandler
import importlib
import json
import traceback
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from minirt.mlx import Mlx, Window
from minirt.mlx.memory import Memory
from tests.mlx.screen_user import ScreenUser
from tests.mlx.user import MemoryUser
from tests.waiting import HANG_LIMIT

if TYPE_CHECKING:
    from collections.abc import Callable

    from tests.mlx.user import User

Log: TypeAlias = list[list[Any]]


class Harness:
    """A window `win` of 200x100 pixels, a log, and the log that is expected of the scenario.

    Exceptions of hooks are raised, or failed assertions would be lost.
    """

    def __init__(self, m: Mlx, title: str, expected: Log) -> None:
        m.mlx_set_options(strict=True, symbols=False)
        self.m = m
        self.mlx = m.mlx_init()
        self.expected = expected
        self.undo = ExitStack()  # of what a scenario has changed for all programs
        self.log: Log = []
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


class Scenario(NamedTuple):
    """A program and its expected log."""

    program: Callable[[Harness], None]
    log: Log


SCENARIOS: dict[str, Scenario] = {}


def scenario(*log: list[Any]) -> Callable[[Callable[[Harness], None]], None]:
    """Register a scenario with its expected log under the name of its function."""

    def register(program: Callable[[Harness], None]) -> None:
        SCENARIOS[program.__name__] = Scenario(program, list(log))

    return register


def load() -> dict[str, Scenario]:
    """Import and return all scenarios by name."""
    for part in ("input", "picture", "loop"):
        importlib.import_module(f"tests.mlx.contract_{part}")
    # Run as a module, this file is loaded twice; the scenarios are registered in the imported module.
    scenarios: dict[str, Scenario] = importlib.import_module("tests.mlx.contract").SCENARIOS
    return scenarios


def run_scenario(name: str, mlx: Mlx) -> Log:
    """Run a scenario and return its log, with the traceback if it raised."""
    program, expected = load()[name]
    harness = Harness(mlx, name, expected)
    try:
        program(harness)
    except Exception:
        harness.record("raised", traceback.format_exc())
    finally:
        mlx.mlx_release(harness.mlx)
    return harness.log


if __name__ == "__main__":
    for name in load():
        # A wait ends by itself after HANG_LIMIT; if even that hangs, print the traceback and end the program.
        faulthandler.dump_traceback_later(2 * HANG_LIMIT, exit=True)
        print(json.dumps([name, run_scenario(name, Mlx())]), flush=True)
        faulthandler.cancel_dump_traceback_later()
