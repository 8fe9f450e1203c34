"""A small run of the benchmark: starts write and show the right picture, systems take turns, tables and charts."""

from __future__ import annotations

from pathlib import Path
from statistics import median

import numpy as np
import pytest
from PIL import Image

from tests.bench import charts, scenes
from tests.bench.__main__ import MiniRT
from tests.bench.measure import Cells, Setting, table, take_turns
from tests.bench.starts import Start, right_picture, shows

ONE = scenes.HERE / "one.rt"


def test_the_table_and_the_charts_of_a_small_run_show_its_medians_and_ratios(tmp_path: Path) -> None:
    """On a logarithmic axis a factor is a distance: 3, 30 and 300 ms lie equally far apart."""
    setting = Setting(32, 18, 1, tmp_path)
    start = Start(setting, cold=True)
    cells: Cells = take_turns([MiniRT(setting, "single"), start], [ONE], 2, 0.0)
    assert shows(np.asarray(Image.open(start.picture(ONE)).convert("RGB")), right_picture(ONE))
    assert not (tmp_path / "cache").exists()
    assert [len(times) for times in cells.values()] == [2, 2]
    (first, second), (head, *rows) = (median(times) for times in cells.values()), table(cells).splitlines()
    assert head.split() == ["ms", "a", "frame", "one"]
    for row, name, ms in zip(rows, ("miniRT single", start.name), (first, second), strict=True):
        assert row.startswith(name)
        figures = [float(each.strip("x")) for each in row.split()[-2:]]
        assert figures == pytest.approx([ms, ms / first], rel=0.06, abs=0.006)
    cells = {("us", "one"): [9, 2, 1], ("us", "two"): [9.996], ("them", "one"): [1.0]}
    assert [line.split() for line in table(cells).splitlines()[1:]] == [
        ["us", "2.00", "x1.0", "10.0", "x1.0"],
        ["them", "1.00", "x0.50", "-"],
    ]
    cells = {("miniRT double", scene): [ms] for scene, ms in {"one": 3.0, "fifty": 30.0, "tenthousand": 300.0}.items()}
    charts.dots(cells, tmp_path / "dots.png", "ms")
    picture = np.asarray(Image.open(tmp_path / "dots.png").convert("RGB"))[100:-80]  # below the legend
    colours = [list(bytes.fromhex(colour[1:])) for colour in charts.COLOURS[:3]]
    near, middle, far = (np.nonzero((picture == colour).all(axis=-1))[1].mean() for colour in colours)
    assert far - middle == pytest.approx(middle - near, rel=0.02)
    assert middle - near > 100
    charts.growth({("miniRT double", str(n)): [n**0.4] for n in (10, 100, 1000)}, tmp_path / "growth.png")
    assert np.asarray(Image.open(tmp_path / "growth.png")).std() > 0
