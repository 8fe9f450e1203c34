"""Both back ends are held to one contract: see contract_input, contract_picture and contract_loop."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from minirt.mlx import Mlx
from minirt.mlx.memory import Memory
from tests.mlx.contract import load, observe
from tests.mlx.contract_process import Troupe
from tests.waiting import HANG_LIMIT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.windows import Desktop


@pytest.fixture(scope="module")
def troupe(desktop: Desktop, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Troupe]:
    """One process for all scenarios on the screen."""
    folder: Path = tmp_path_factory.mktemp("troupe")
    with Troupe(desktop, folder / "errors") as opened:
        yield opened


@pytest.mark.parametrize("name", load())
def test_memory(name: str) -> None:
    assert observe(name, Mlx(Memory(patience=HANG_LIMIT))) == load()[name].log


@pytest.mark.window
@pytest.mark.parametrize("name", load())
def test_screen(name: str, troupe: Troupe) -> None:
    assert troupe.play(name) == load()[name].log
