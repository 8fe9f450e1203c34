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
    charts.dots({("miniRT double", scene): Cell(1, [Round(ms, 0)]) for scene, ms in times.items()}, path, "ms")
    picture = np.asarray(Image.open(path).convert("RGB"))[100:-80]  # below the legend, which has the same marks
    columns = [np.nonzero((picture == list(bytes.fromhex(c[1:]))).all(axis=-1))[1].mean() for c in charts.SCENES[:3]]
    near, middle, far = columns
    assert far - middle == pytest.approx(middle - near, rel=0.02)
    assert middle - near > 100


@pytest.mark.parametrize(
    ("values", "heights"),
    [
        ([1.0, 10.0, 100.0, 1000.0], [7, -15, 7, -15]),
        ([1.0, 1.1, 1.2, 1.3], [7, -15, 17, -25]),
        ([1.0, 1.1, 1.2, 9.0], [7, -15, 17, -15]),
    ],
)
def test_labels_of_near_values_do_not_overlap(values: list[float], heights: list[int]) -> None:
    assert charts.offsets(values) == heights


def test_a_scene_that_a_system_does_not_render_has_no_dot(tmp_path: Path) -> None:
    cells = {(system, "one"): Cell(1, [Round(3.0, 0)]) for system in SYSTEMS}
    drawn = []
    for mesh in (SYSTEMS[:1], SYSTEMS):
        charts.dots(
            cells | {(system, "mesh"): Cell(1, [Round(9.0, 0)]) for system in mesh}, tmp_path / "dots.png", "ms"
        )
        drawn.append([pixels_of(tmp_path / "dots.png", colour) for colour in charts.SCENES[:2]])
    (ones, few), (same, many) = drawn
    assert same == ones
    assert many == pytest.approx(few * 3 / 2, rel=0.2)  # the legend has a dot, too


def test_the_growth_has_a_line_for_each_system(tmp_path: Path) -> None:
    path = tmp_path / "growth.png"
    charts.growth({(s, str(n)): Cell(1, [Round(n**0.4, 0)]) for s in SYSTEMS[:1] for n in (10, 100, 1000)}, path)
    assert pixels_of(path, charts.COLOURS[SYSTEMS[0]]) > 1000
    assert pixels_of(path, charts.OTHERS) == 0
