"""The page of a report, in a real browser without network."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
from PIL import Image

from minirt.report.document import PAGE, report_files
from tests.browser import Page, page
from tests.report.made_up import FINDINGS, ROWS

__all__ = ["page"]
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
    page.open(file, height=2000)
    assert page.value("document.title") == "scenes/<ball>.rt: error against run time"
    assert page.requests[0] == file.as_uri()
    assert {each.partition(":")[0] for each in page.requests[1:]} == {"data"}
    assert page.value("[...document.images].every(each => each.complete && each.naturalWidth > 0)")
    names = page.value("[...document.querySelectorAll('.pictures img')].map(each => each.alt)")
    assert len(names) == len(ROWS)  # the last row has none, and the reference is one more
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
