"""The window contract as programs with known logs, on either back end.

Each scenario is held to the same log on both by test_contract. Run as a module, this plays scenarios on the screen: it
reads their names from standard input, a line each, and answers each with the log as a line of JSON.
"""

from __future__ import annotations

import faulthandler
import importlib
import json
import sys
import traceback
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from minirt.mlx import Mlx
from tests.mlx.stage import Stage
from tests.waiting import HANG_LIMIT

if TYPE_CHECKING:
    from collections.abc import Callable

Log: TypeAlias = list[list[Any]]


class Scenario(NamedTuple):
    """A program, and the log that it must leave."""

    play: Callable[[Stage], None]
    log: Log


SCENARIOS: dict[str, Scenario] = {}


def scenario(*log: list[Any]) -> Callable[[Callable[[Stage], None]], None]:
    """Register a scenario under its function's name."""

    def register(play: Callable[[Stage], None]) -> None:
        SCENARIOS[play.__name__] = Scenario(play, list(log))

    return register


def load() -> dict[str, Scenario]:
    """All scenarios by name."""
    for room in ("input", "picture", "loop"):
        importlib.import_module(f"tests.mlx.contract_{room}")
    # Run as a module, this file exists twice; the scenarios are in the imported one.
    scenarios: dict[str, Scenario] = importlib.import_module("tests.mlx.contract").SCENARIOS
    return scenarios


def observe(name: str, mlx: Mlx) -> Log:
    """Play a scenario and return its log, with the traceback where it raised."""
    play, expected = load()[name]
    stage = Stage(mlx, name, expected)
    try:
        play(stage)
    except Exception:
        stage.note("raised", traceback.format_exc())
    finally:
        mlx.mlx_release(stage.mlx)
    return stage.log


if __name__ == "__main__":
    for line in sys.stdin:
        # A wait in vain ends by itself; where even that hangs, this says in which line, and ends the program.
        faulthandler.dump_traceback_later(2 * HANG_LIMIT, exit=True)
        print(json.dumps(observe(line.strip(), Mlx())), flush=True)
        faulthandler.cancel_dump_traceback_later()
