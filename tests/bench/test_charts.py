"""The charts show the measured times."""

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
    """Count the pixels of a colour."""
    wanted = list(bytes.fromhex(colour[1:]))
    return int((np.asarray(Image.open(path).convert("RGB")) == wanted).all(axis=-1).sum())


def test_dots_lie_further_right_for_longer_times(tmp_path: Path) -> None:
    """On a logarithmic axis a factor is a distance: 3, 30 and 300 ms lie equally far apart."""
    path = tmp_path / "dots.png"
    times = {"one": 3.0, "fifty": 30.0, "tenthousand": 300.0}
    charts.dots({("miniRT double", scene): Cell(1, [Round(ms, 0)]) for scene, ms in times.items()}, path)
    picture = np.asarray(Image.open(path).convert("RGB"))[100:-80]  # below the legend, which has the same marks
    columns = [np.nonzero((picture == list(bytes.fromhex(c[1:]))).all(axis=-1))[1].mean() for c in charts.SCENES]
    near, middle, far = columns
    assert far - middle == pytest.approx(middle - near, rel=0.02)
    assert middle - near > 100


def test_the_growth_has_a_line_for_each_system(tmp_path: Path) -> None:
    path = tmp_path / "growth.png"
    charts.growth({(s, str(n)): Cell(1, [Round(n**0.4, 0)]) for s in SYSTEMS[:1] for n in (10, 100, 1000)}, path)
    assert pixels_of(path, charts.COLOURS[SYSTEMS[0]]) > 1000
    assert pixels_of(path, charts.OTHERS) == 0
