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
from minirt.report.page import DETAIL, columns
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
    parts = ["## Settings", "## Orders of convergence", "## What parts cost and save", "## Certificates of hits"]
    parts += ["## Stiff parts of the scene"]
    assert [each for each in lines(FINDINGS) if each in parts] == parts
    nothing = replace(FINDINGS, pictures=[], ablation=[], stiff=[], certificates=[])
    assert not set(lines(nothing)) & set(parts[1:])


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
    alone = report_files(FINDINGS, {}, BLACK)["report.html"]
    assert b"data:image/png" not in alone  # nothing to compare: no slider
    assert b'class="pictures"' not in alone
    assert b'<a href="error-uniform-1.png">' in made["report.html"]
    assert b"![Error against run time](diagram.svg)" in made["report.md"]
    for name, knob in (("report.html", "&lt;slow&gt; &amp; sure"), ("report.md", "<slow> & sure")):
        for figure in (knob, "0.01000", "0.03600", "tiles", "+100.0"):
            assert figure in made[name].decode()


class Made(NamedTuple):
    """A record of a table; a field without a title is not shown."""

    word: Annotated[str, "a `b`"]
    number: Annotated[float, "y", ".2f", DETAIL] = nan
    hidden: int = 0
    truth: Annotated[bool, "z"] = True


BEST, OTHER = Made("k|nob"), Made("<c>", 0.125)


def test_a_table_shows_the_titled_fields_of_records_that_tell_something() -> None:
    """A dash for NaN, words for truth."""
    word, number = columns([BEST, OTHER])
    assert word == ("a `b`", "word", ["k|nob", "<c>"])
    assert number == ("y", "number detail", ["-", "0.12"])
    assert columns([BEST, OTHER._replace(truth=False)])[2] == ("z", "word", ["yes", "no"])
    assert columns([]) == []


def test_the_best_rows_stand_out_and_text_is_no_markup() -> None:
    """In bold, and marked on the page; a bar ends no cell."""
    best = FINDINGS.recommended[-1]
    row = best._replace(label="1|6", remark="<c> `d`")
    made = report_files(replace(FINDINGS, pictures=[row if each == best else each for each in ROWS]), {}, BLACK)
    assert b"| **single** | 1\\|6 |" in made["report.md"]
    assert b'<tr class="emphasised"><td class="word">single</td><td class="word">1|6</td>' in made["report.html"]
    assert b"&lt;c&gt; <code>d</code></td>" in made["report.html"]
    assert b'<tr class="plain"><td class="word">&lt;slow&gt; &amp; sure</td>' in made["report.html"]


@pytest.mark.parametrize("size", [WIDE, NARROW])
def test_the_diagram_shows_each_line_and_each_point(size: tuple[float, float]) -> None:
    svg = draw(FINDINGS, size)
    words = [each.text for each in ElementTree.fromstring(svg).iter("{http://www.w3.org/2000/svg}text")]
    shown = {each.strip() for each in words if each}
    assert {*NAMES, "recommended", "rounding to 8 bits: 0.0011"} <= shown
    assert "error of the reference: 0.0002" not in shown  # which lies far below all errors
    assert sum(each in ("1", "4", "16") for each in words) >= POINTS
    assert draw(FINDINGS, size) == svg
    nothing = replace(FINDINGS, pictures=[row._replace(options="") for row in ROWS])
    assert "recommended" not in draw(nothing, size)  # where nothing is


def test_a_diagram_without_points_is_drawn() -> None:
    assert "milliseconds per picture" in draw(replace(FINDINGS, pictures=[Row("auto", "1", remark="failed")]), WIDE)


@pytest.mark.parametrize("package", ["matplotlib.backends.backend_svg", "jinja2"])
def test_what_is_missing_is_asked_for(package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(RenderError, match=r"pip install 'minirt\[report\]'"):
        diagram.require_packages()


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
    full = ROWS[0]._replace(flip=0.0123, error_median=1e-5, error_95=0.012, error_largest=0.9, estimated=0.00123)
    slow = full._replace(knob="no bounces", ms=12345.67, ms_low=12000.0, ms_high=13000.0, remark="left out: 1.2e+02 s")
    failed = Part("kind", "light buffers and their cones", "without", remark="failed: 4096 shapes in each of 8 lists")
    crowded = replace(FINDINGS, pictures=[slow, *ROWS], ablation=[*FINDINGS.ablation, failed])
    file.write_bytes(report_files(crowded, lights, np.zeros((HEIGHT, WIDTH, 3)))[PAGE])
    for width in (800, 1300):
        page.open(file, width, height=2000)
        cut = "e => e.scrollWidth > e.clientWidth"
        assert page.value(f"[...document.querySelectorAll('.scroll')].filter({cut}).map(e => e.innerText)") == [], width
        heights = page.value("[...document.querySelectorAll('tr')].map(e => e.getBoundingClientRect().height)")
        assert max(heights) < 1.5 * min(heights), width  # one line each
    assert page.value("document.title") == "scenes/<ball>.rt: error against run time"
    assert page.requests[0] == file.as_uri()
    assert {each.partition(":")[0] for each in page.requests[1:]} == {"data"}
    assert page.value("[...document.images].every(each => each.complete && each.naturalWidth > 0)")
    names = page.value("[...document.querySelectorAll('.pictures img')].map(each => each.alt)")
    assert names[1::2] == [f"{row.name}: {row.ms:.4g} ms, RMSE {row.rmse:.2g}" for row in crowded.of_equal_time]
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
