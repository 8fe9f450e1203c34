"""Run the scenarios of contract_input, contract_picture and contract_loop on both back ends."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from minirt.mlx import Mlx
from minirt.mlx.memory import Memory
from tests.mlx.contract import load, run_scenario
from tests.mlx.contract_process import ScenarioProcess
from tests.waiting import HANG_LIMIT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.windows import Desktop


@pytest.fixture(scope="module")
def scenario_process(desktop: Desktop, tmp_path_factory: pytest.TempPathFactory) -> Iterator[ScenarioProcess]:
    """One process for all scenarios on the screen."""
    folder: Path = tmp_path_factory.mktemp("process")
    with ScenarioProcess(desktop, folder / "errors") as started:
        yield started


@pytest.mark.parametrize("name", load())
def test_memory(name: str) -> None:
    assert run_scenario(name, Mlx(Memory(patience=HANG_LIMIT))) == load()[name].log


@pytest.mark.window
@pytest.mark.parametrize("name", load())
def test_screen(name: str, scenario_process: ScenarioProcess) -> None:
    assert scenario_process.run(name) == load()[name].log
