"""Both back ends are held to one contract: see contract_input, contract_picture and contract_loop."""

from __future__ import annotations

import json
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from minirt.mlx import Mlx
from minirt.mlx.memory import Memory
from tests.mlx.contract import load, observe
from tests.windows import ROOT

if TYPE_CHECKING:
    from tests.mlx.contract import Log
    from tests.windows import Desktop


@pytest.fixture(scope="module")
def screen_logs(desktop: Desktop) -> dict[str, Log]:
    """All scenarios, played on the screen by one process."""
    command = [sys.executable, "-W", "error", "-m", "tests.mlx.contract"]
    done = subprocess.run(
        command, env=desktop.environment, cwd=ROOT, capture_output=True, text=True, timeout=90, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    logs: dict[str, Log] = json.loads(done.stdout)
    return logs


@pytest.mark.parametrize("name", load())
def test_memory(name: str) -> None:
    assert observe(name, Mlx(Memory(patience=5.0))) == load()[name].log


@pytest.mark.window
@pytest.mark.parametrize("name", load())
def test_screen(name: str, screen_logs: dict[str, Log]) -> None:
    assert screen_logs[name] == load()[name].log
