"""The report of a scene tells what was found, in which order, in both forms, and draws it."""

from __future__ import annotations

import io
import re
import sys
from dataclasses import replace
from math import nan
from pathlib import Path
from typing import Annotated, NamedTuple
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

from minirt.errors import RenderError
from minirt.report import diagram
from minirt.report.ablation import Part
from minirt.report.diagram import NARROW, WIDE, draw
from minirt.report.document import PAGE, report_files
from minirt.report.findings import Findings, Order
from minirt.report.page import as_html, table
from minirt.report.pictures import Row
from tests.browser import Page, page
from tests.paths import PACKAGE
from tests.report.made_up import FINDINGS, NAMES, POINTS, ROWS

__all__ = ["page"]
BLACK = np.zeros((2, 2, 3))
README = (PACKAGE / "report" / "README.md").read_text(encoding="utf-8")


@pytest.fixture(autouse=True)
def no_diagram(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave the diagram, which takes a second, to the tests that look at it."""
    if "page" not in request.fixturenames:
        monkeypatch.setattr("minirt.report.document.draw", lambda found, size: "<svg/>")


def lines(found: Findings) -> list[str]:
    return report_files(found, {}, BLACK)["report.md"].decode().splitlines()


def test_the_order_of_the_sections_and_none_for_what_was_not_measured() -> None:
    first = {line[:2]: number for number, line in reversed([*enumerate(lines(FINDINGS))])}
    assert first["# "] < first["- "] < first["!["] < first["| "]
    parts = ["## Settings", "## Orders of convergence", "## What parts cost and save", "## Stiff parts of the scene"]
    parts += ["## Certificates of hits", "## Not measured"]
    assert [each for each in lines(FINDINGS) if each in parts] == parts
    nothing = replace(FINDINGS, pictures=[], ablation=[], stiff=[], certificates=[], not_measured=[])
    assert not set(lines(nothing)) & set(parts)


def test_the_page_leaves_out_pictures_that_repeat_another_and_hits_of_easy_kinds() -> None:
    """The files have both."""
    same, easy = ROWS[0]._replace(knob="the same"), FINDINGS.certificates[0]._replace(kind="disc", backward_largest=1.0)
    found = replace(FINDINGS, pictures=[*ROWS, same], certificates=[*FINDINGS.certificates, easy])
    made = report_files(found, {}, BLACK)
    assert b"\nthe same,1," in made["pictures.csv"]
    assert b"\ndisc," in made["certificates.csv"]
    assert b"| sphere |" in made["report.md"]
    assert not re.search(rb"\| (the same|disc) \|", made["report.md"])


def test_every_picture_is_a_file_and_in_the_page_and_both_forms_tell_every_figure() -> None:
    made = report_files(FINDINGS, {ROWS[0].name: BLACK, ROWS[4].name: BLACK}, BLACK)
    pictures = {"error-uniform-1.png", "error-adaptive-16.png", "reference.png"}
    assert {name for name in made if name.endswith(".png")} == pictures
    assert made["report.html"].count(b"data:image/png;base64,") == 6  # the reference, adaptive 16, its errors; crops
    assert b'<a href="error-uniform-1.png">' in made["report.html"]
    assert b"![Error against run time](diagram.svg)" in made["report.md"]
    for name, knob in (("report.html", "&lt;slow&gt; &amp; sure"), ("report.md", "<slow> & sure")):
        for figure in (knob, "0.01000", "0.03600", "tiles", "+100.0"):
            assert figure in made[name].decode()
        assert b"POV-Ray is not installed" in made[name]


class Made(NamedTuple):
    """A record of a table; a field without a title is not shown."""

    word: Annotated[str, "a `b`"]
    number: Annotated[float, "y", ".2f"] = nan
    hidden: int = 0
    truth: Annotated[bool, "z"] = True


def test_a_table_shows_the_titled_fields_of_records_that_tell_something() -> None:
    """A dash for NaN, words for truth, a bar that ends no cell; the best rows in bold, and marked on the page."""
    best, other = Made("k|nob"), Made("<c>", 0.125)
    made = table([best, other], [best])
    assert made.splitlines() == ["| a `b` | y |", "| --- | ---: |", "| **k\\|nob** | - |", "| <c> | 0.12 |"]
    assert table([best, other._replace(truth=False)]).splitlines()[3] == "| <c> | 0.12 | no |"
    for html in (
        '<tr class="plain"><th class="word">a <code>b</code></th><th class="number">y</th></tr>',
        '<tr class="emphasised"><td class="word"><b>k|nob</b></td><td class="number">-</td></tr>',
        '<tr class="plain"><td class="word">&lt;c&gt;</td>',
    ):
        assert html in as_html(made)


@pytest.mark.parametrize("size", [WIDE, NARROW])
def test_the_diagram_shows_each_line_and_each_point(size: tuple[float, float]) -> None:
    svg = draw(FINDINGS, size)
    words = [each.text for each in ElementTree.fromstring(svg).iter("{http://www.w3.org/2000/svg}text")]
    shown = {each.strip() for each in words if each}
    assert {*NAMES, "recommended", "rounding to 8 bits: 0.0011"} <= shown
    assert "error of the reference: 0.0002" not in shown  # which lies far below all errors
    assert sum(each in ("1", "4", "16") for each in words) >= POINTS
    assert draw(FINDINGS, size) == svg


def test_a_diagram_without_points_is_drawn() -> None:
    assert "milliseconds per picture" in draw(replace(FINDINGS, pictures=[Row("auto", "1", remark="failed")]), WIDE)


def test_matplotlib_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.backends.backend_svg", None)
    with pytest.raises(RenderError, match=r"pip install 'minirt\[report\]'"):
        diagram.require_matplotlib()


@pytest.mark.parametrize(
    ("table", "fields"), [("pictures.csv", Row._fields), ("orders.csv", Order._fields), ("ablation.csv", Part._fields)]
)
def test_the_page_about_reports_explains_every_field(table: str, fields: tuple[str, ...]) -> None:
    own = re.split(r"\n\| `\w+\.csv` \||\n\n", README.split(f"| `{table}` |")[1])[0]
    assert set(re.findall(r"`(\w+)`", own)) == set(fields)


# The page, in a real browser without network.

HEIGHT, WIDTH = 20, 32


def shown(page: Page) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(page.screenshot())).convert("RGB")).astype(int)


def box(page: Page, selector: str) -> dict[str, float]:
    return dict(page.value(f"document.querySelector('{selector}').getBoundingClientRect().toJSON()"))


def test_the_page_of_a_report(page: Page, tmp_path: Path) -> None:
    """It asks for nothing, fits its window, follows the user's colours, and compares pictures; nothing is wrong."""
    lights = {row.name: np.full((HEIGHT, WIDTH, 3), 0.001 * index) for index, row in enumerate(ROWS[:-1])}
    file = tmp_path / PAGE
    file.write_bytes(report_files(FINDINGS, lights, np.zeros((HEIGHT, WIDTH, 3)))[PAGE])
    page.open(file, 1300, height=2000)
    assert page.value("[...document.querySelectorAll('.scroll')].every(each => each.scrollWidth <= each.clientWidth)")
    assert page.value("document.title") == "scenes/<ball>.rt: error against run time"
    assert page.requests[0] == file.as_uri()
    assert {each.partition(":")[0] for each in page.requests[1:]} == {"data"}
    assert page.value("[...document.images].every(each => each.complete && each.naturalWidth > 0)")
    names = page.value("[...document.querySelectorAll('.pictures img')].map(each => each.alt)")
    assert names[1::2] == [f"{row.name}: {row.wall_ms:.4g} ms, RMSE {row.rmse:.2g}" for row in FINDINGS.of_equal_time]
    assert page.value("[...document.querySelectorAll('select.left option')].map(each => each.text)") == names

    panes = box(page, ".panes")
    y = round(panes["y"] + panes["height"] / 2)
    left, right = (round(panes["x"] + share * panes["width"]) for share in (0.3, 0.7))
    one, other = (shown(page)[y, x].tolist() for x in (left, right))
    assert one != other
    page.value("document.querySelector('.comparison input').focus()")
    page.press("End", 35)
    assert [shown(page)[y, x].tolist() for x in (left, right)] == [one, one]
    page.drag((panes["x"] + 5, y), (panes["x"] + 0.5 * panes["width"], y))
    assert [shown(page)[y, x].tolist() for x in (left, right)] == [one, other]
    assert np.median(shown(page)) > 240
    assert page.complaints == []

    for width, seen, hidden in ((1000, ".wide", ".narrow"), (380, ".narrow", ".wide")):
        page.open(file, width, is_dark=True)
        assert page.value("document.documentElement.scrollWidth") == width
        assert box(page, f"{seen} svg")["width"] > 0.85 * min(width, 960)
        assert box(page, hidden)["width"] == 0
        assert np.median(shown(page)) < 40

    (tmp_path / "changed.html").write_text(
        file.read_text().replace("</main>", '<img src="https://example.invalid/picture.png"></main>')
    )
    page.open(tmp_path / "changed.html")  # the browser itself refuses to leave the page
    assert any("Content Security Policy" in each for each in page.complaints)
