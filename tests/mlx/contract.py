"""The contract of back ends as scenarios: small programs with known logs.

`test_contract` runs each scenario on both back ends and expects the same log. Run as a module, this file runs scenarios
on the screen: it reads their names from standard input, one a line, and answers each with its log as a line of JSON.
"""

from __future__ import annotations

import faulthandler
import importlib
import json
import sys
import traceback
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from minirt.mlx import Mlx
from tests.mlx.harness import Harness
from tests.waiting import HANG_LIMIT

if TYPE_CHECKING:
    from collections.abc import Callable

Log: TypeAlias = list[list[Any]]


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
    for line in sys.stdin:
        # A wait ends by itself after HANG_LIMIT; if even that hangs, print the traceback and end the program.
        faulthandler.dump_traceback_later(2 * HANG_LIMIT, exit=True)
        print(json.dumps(run_scenario(line.strip(), Mlx())), flush=True)
        faulthandler.cancel_dump_traceback_later()
