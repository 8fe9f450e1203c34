"""Run the scenarios of contract_input, contract_picture and contract_loop on both back ends."""

from __future__ import annotations

import json
import sys
from typing import TYPE_CHECKING

import pytest

from minirt.mlx import Mlx
from minirt.mlx.memory import Memory
from tests.mlx.contract import load, run_scenario
from tests.waiting import HANG_LIMIT

if TYPE_CHECKING:
    from tests.mlx.contract import Log
    from tests.windows import Desktop


@pytest.fixture(scope="module")
def shown(desktop: Desktop) -> dict[str, Log]:
    """Fixture: the logs of all scenarios, which one program has run on the screen without a warning."""
    with desktop.program(sys.executable, "-W", "error", "-m", "tests.mlx.contract") as process:
        output, errors = process.communicate(timeout=len(load()) * HANG_LIMIT)
    assert (process.returncode, errors) == (0, ""), output
    return dict(map(json.loads, output.splitlines()))


@pytest.mark.parametrize("name", load())
def test_memory(name: str) -> None:
    assert run_scenario(name, Mlx(Memory(patience=HANG_LIMIT))) == load()[name].log


@pytest.mark.window
@pytest.mark.parametrize("name", load())
def test_screen(name: str, shown: dict[str, Log]) -> None:
    assert shown[name] == load()[name].log
