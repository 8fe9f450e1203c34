"""The report of a scene tells what was found, and in which order."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.report.measurements.findings import Findings
from minirt.report.output.blocks import Bullets, Diagrams, Heading, Notice, Table
from minirt.report.output.document import advice, document
from minirt.report.output.files import formula_files, report_files
from tests.report.made_up import FINDINGS, ROWS

DIAGRAMS = Diagrams("", "", "diagram.svg", "<svg/>", "<svg/>")
BLACK = np.zeros((2, 2, 3))


def headings(found: Findings) -> list[str]:
    return [block.text for block in document(found, DIAGRAMS, []) if isinstance(block, Heading)]


def test_the_diagram_and_the_advice_come_before_the_tables() -> None:
    sorts = [type(block) for block in document(FINDINGS, DIAGRAMS, [])]
    assert sorts.index(Diagrams) < sorts.index(Bullets) < sorts.index(Table)


def test_what_was_not_measured_has_no_section() -> None:
    parts = ["Orders of convergence", "What parts cost and save", "Single precision, feature by feature", "Formulas"]
    assert [each for each in headings(FINDINGS) if each in parts] == parts
    empty = FINDINGS._replace(orders=[], ablation=[], single=[], kernels=[])
    assert not set(headings(empty)) & set(parts)


def test_an_interrupt_is_told_first() -> None:
    blocks = list(document(FINDINGS._replace(interrupted="Stopped."), DIAGRAMS, []))
    assert blocks[1] == Notice("Stopped.")
    assert not [block for block in document(FINDINGS, DIAGRAMS, []) if isinstance(block, Notice)]


def test_disturbed_settings_are_counted_and_not_recommended() -> None:
    lines = list(advice(FINDINGS))
    assert lines[-1] == "left out, as other programs disturbed their times: 1"
    assert "error at most 0.01: single, 4 samples (9 ms, RMSE 0.01, 30.0 dB)" in lines
    calm = FINDINGS._replace(pictures=[row._replace(valid=True, remark="") for row in ROWS])
    assert "error at most 0.01: adaptive, 4 samples (7 ms, RMSE 0.01, 30.0 dB)" in list(advice(calm))
    assert not [line for line in advice(calm) if "left out" in line]


def test_every_picture_is_a_file_and_in_the_page() -> None:
    made = report_files(FINDINGS, {ROWS[0].name: BLACK, ROWS[4].name: BLACK}, BLACK)
    assert {name for name in made if name.endswith(".png")} == {
        "error-uniform-1.png",
        "error-adaptive-16.png",
        "reference.png",
    }
    assert made["report.html"].count(b"data:image/png;base64,") == 3
    assert made["diagram.svg"].startswith(b"<svg ")
    assert b"![Error against run time](diagram.svg)" in made["report.md"]


@pytest.mark.parametrize("name", ["report.html", "report.md"])
def test_both_forms_tell_every_figure(name: str) -> None:
    text = report_files(FINDINGS, {}, BLACK)[name].decode()
    for figure in ("0.01000", "0.03600", "tiles", "+100.0", "shapes alone", "1.0e-07", "formula of the blob"):
        assert figure in text
    assert ("&lt;slow&gt; &amp; sure" if name == "report.html" else "<slow> & sure") in text


def test_the_formulas_have_a_page_of_their_own() -> None:
    made = formula_files(FINDINGS.kernels, "Stopped.")
    assert b"Stopped." in made["kernels.html"]
    assert b"| sphere | benign |" in made["kernels.md"]
