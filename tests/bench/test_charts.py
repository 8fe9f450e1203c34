"""The pictures show what was measured."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.bench.measure import Cell, Round
from tests.bench.system import INSTALL

charts = pytest.importorskip("tests.bench.charts", reason=f"needs matplotlib; {INSTALL}", exc_type=ImportError)
SYSTEMS = "miniRT double", "Tachyon"


def pixels_of(path: Path, colour: str) -> int:
    """How many pixels have that colour."""
    wanted = list(bytes.fromhex(colour[1:]))
    return int((np.asarray(Image.open(path).convert("RGB")) == wanted).all(axis=-1).sum())


def test_bars_are_longer_for_what_takes_longer(tmp_path: Path) -> None:
    path = tmp_path / "bars.png"
    charts.bars({(s, "one"): Cell(1, [Round(ms, 0)]) for s, ms in zip(SYSTEMS, (3, 30), strict=True)}, path)
    ours, theirs = (pixels_of(path, charts.COLOURS.get(system, charts.OTHERS)) for system in SYSTEMS)
    assert theirs / ours == pytest.approx(2, rel=0.05)  # the axis begins at 0.3


def test_the_growth_has_a_line_for_each_system(tmp_path: Path) -> None:
    path = tmp_path / "growth.png"
    charts.growth({(s, str(n)): Cell(1, [Round(n**0.4, 0)]) for s in SYSTEMS[:1] for n in (10, 100, 1000)}, path)
    assert pixels_of(path, charts.COLOURS[SYSTEMS[0]]) > 1000
    assert pixels_of(path, charts.OTHERS) == 0
