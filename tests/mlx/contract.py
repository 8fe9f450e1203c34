"""The window contract as programs with known logs, on either back end.

Each scenario is held to the same log on both by test_contract. Run as a module, this plays all of them on the screen
and prints the logs as JSON.
"""

from __future__ import annotations

import importlib
import json
import traceback
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from minirt.mlx import Mlx
from tests.mlx.stage import Stage

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
    stage = Stage(mlx, name, len(expected))
    try:
        play(stage)
    except Exception:
        stage.note("raised", traceback.format_exc())
    finally:
        mlx.mlx_release(stage.mlx)
    return stage.log


if __name__ == "__main__":
    print(json.dumps({name: observe(name, Mlx()) for name in load()}))
