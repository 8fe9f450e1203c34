"""The report of a scene tells what was found, in which order, in both forms, and draws it."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import numpy as np
import pytest

from minirt.errors import RenderError
from minirt.report import page
from minirt.report.ablation import Part
from minirt.report.document import advice, document, report_files
from minirt.report.findings import Findings, Order
from minirt.report.page import NARROW, WIDE, Column, Document, draw
from minirt.report.pictures import Row
from minirt.report.precision import SingleError
from tests.paths import PACKAGE
from tests.report.made_up import FINDINGS, NAMES, POINTS, ROWS

BLACK = np.zeros((2, 2, 3))
README = (PACKAGE / "report" / "README.md").read_text(encoding="utf-8")


@pytest.fixture(autouse=True)
def no_diagram(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave the diagram, which takes a second, to the tests that look at it."""
    monkeypatch.setattr("minirt.report.document.draw", lambda found, size: "<svg/>")


def lines(found: Findings) -> list[str]:
    return document(found, []).as_markdown().splitlines()


def test_the_diagram_and_the_advice_come_before_the_tables() -> None:
    first = {line[:2]: number for number, line in reversed([*enumerate(lines(FINDINGS))])}
    assert first["# "] < first["!["] < first["- "] < first["| "]


def test_what_was_not_measured_has_no_section() -> None:
    parts = ["## Orders of convergence", "## What parts cost and save", "## Single precision, feature by feature"]
    assert [each for each in lines(FINDINGS) if each in parts] == parts
    assert not set(lines(FINDINGS._replace(orders=[], ablation=[], single=[]))) & set(parts)


def test_an_interrupt_is_told_first() -> None:
    assert lines(FINDINGS._replace(interrupted="Stopped."))[2] == "**Stopped.**"
    assert 'role="alert">Stopped.<' in document(FINDINGS._replace(interrupted="Stopped."), []).as_page()


def test_disturbed_settings_are_counted_and_not_recommended() -> None:
    told = list(advice(FINDINGS))
    assert told[-1] == "left out, as other programs disturbed their times: 1"
    assert "error at most 0.01: single, 4 samples (9 ms, RMSE 0.01, 30.0 dB)" in told
    calm = FINDINGS._replace(pictures=[row._replace(valid=True, remark="") for row in ROWS])
    assert "error at most 0.01: adaptive, 4 samples (7 ms, RMSE 0.01, 30.0 dB)" in list(advice(calm))
    assert not [line for line in advice(calm) if "left out" in line]


def test_every_picture_is_a_file_and_in_the_page() -> None:
    made = report_files(FINDINGS, {ROWS[0].name: BLACK, ROWS[4].name: BLACK}, BLACK)
    pictures = {"error-uniform-1.png", "error-adaptive-16.png", "reference.png"}
    assert {name for name in made if name.endswith(".png")} == pictures
    assert made["report.html"].count(b"data:image/png;base64,") == 3
    assert b"![Error against run time](diagram.svg)" in made["report.md"]


@pytest.mark.parametrize("name", ["report.html", "report.md"])
def test_both_forms_tell_every_figure(name: str) -> None:
    text = report_files(FINDINGS, {}, BLACK)[name].decode()
    for figure in ("0.01000", "0.03600", "tiles", "+100.0", "shapes alone", "1.0e-07", "POV-Ray is not installed"):
        assert figure in text
    assert ("&lt;slow&gt; &amp; sure" if name == "report.html" else "<slow> & sure") in text


def test_cells_of_tables() -> None:
    """A dash for NaN, words for truth, a bar that ends no cell; the best rows in bold."""
    made, row = Document("a `b`"), Row("k|nob", "1", valid=True)
    made.table([row, Row("c", "2")], [Column("x", "knob"), Column("y", "rmse", ".2f"), Column("z", "valid")], [row])
    assert made.markdown[1].splitlines()[1:] == ["|---|---:|---|", "| **k\\|nob** | - | yes |", "| c | - | no |"]
    assert '<tr class="emphasised"><td class="word">k|nob</td><td class="number">-</td>' in made.html[1]
    assert made.html[0] == "<h1>a <code>b</code></h1>"


@pytest.mark.parametrize("size", [WIDE, NARROW])
def test_the_diagram_shows_each_line_and_each_point(size: tuple[float, float]) -> None:
    svg = draw(FINDINGS, size)
    words = [each.text for each in ElementTree.fromstring(svg).iter("{http://www.w3.org/2000/svg}text")]
    shown = {each.strip() for each in words if each}
    assert {*NAMES, "recommended", "Pareto front", "rounding to 8 bits: 0.0011"} <= shown
    assert "error of the reference: 0.0002" not in shown  # which lies far below all errors
    assert sum(each in ("1", "4", "16") for each in words) >= POINTS
    assert draw(FINDINGS, size) == svg


def test_a_diagram_without_points_is_drawn() -> None:
    assert "milliseconds per picture" in draw(FINDINGS._replace(pictures=[Row("auto", "1", remark="failed")]), WIDE)


def test_matplotlib_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page, "find_spec", lambda name: None)
    with pytest.raises(RenderError, match=r"pip install 'minirt\[report\]'"):
        page.require_matplotlib()


@pytest.mark.parametrize(
    ("table", "fields"),
    [
        ("pictures.csv", Row._fields),
        ("orders.csv", Order._fields),
        ("ablation.csv", Part._fields),
        ("single.csv", SingleError._fields),
    ],
)
def test_the_page_about_reports_explains_every_field(table: str, fields: tuple[str, ...]) -> None:
    own = re.split(r"\n\| `\w+\.csv` \||\n\n", README.split(f"| `{table}` |")[1])[0]
    assert set(re.findall(r"`(\w+)`", own)) == set(fields)
