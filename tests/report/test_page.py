"""The page of a report, in a real browser without network."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from minirt.report.document import PAGE, report_files
from tests import browser
from tests.browser import Page, page, require_browser
from tests.report.made_up import FINDINGS, POINTS, ROWS

__all__ = ["page"]
pytestmark = pytest.mark.slow
WIDTH, HEIGHT = 32, 20
OVERLAPPING = """
(() => {
  const boxes = [...document.querySelectorAll("%s .diagram text")].map(each => each.getBoundingClientRect());
  return boxes.filter((one, index) => boxes.some((other, place) => place > index && one.left + 1 < other.right &&
    other.left + 1 < one.right && one.top + 2 < other.bottom && other.top + 2 < one.bottom)).length;
})()
"""
PLANTED = """<!doctype html><title>planted</title><img src="https://example.invalid/picture.png">
<script>console.error("planted"); missing();</script>"""


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Fixture: the page of a made-up report, whose error pictures have one colour each."""
    lights = {row.name: np.full((HEIGHT, WIDTH, 3), 0.001 * index) for index, row in enumerate(ROWS[:-1])}
    made = report_files(FINDINGS, lights, np.zeros((HEIGHT, WIDTH, 3)))
    path = tmp_path_factory.mktemp("report") / PAGE
    path.write_bytes(made[PAGE])
    return path


def shown(page: Page) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(page.screenshot())).convert("RGB")).astype(int)


def box(page: Page, selector: str) -> dict[str, float]:
    found = page.value(f"document.querySelector('{selector}').getBoundingClientRect().toJSON()")
    return dict(found)


def test_it_asks_for_nothing_and_nothing_is_wrong_with_it(page: Page, file: Path) -> None:
    page.open(file)
    assert page.value("document.title") == "scenes/<ball>.rt: error against run time"
    assert page.complaints == []
    assert page.requests[0] == file.as_uri()
    assert {each.partition(":")[0] for each in page.requests[1:]} == {"data"}


def test_a_page_with_a_foreign_picture_and_a_mistake_would_be_found(page: Page, tmp_path: Path) -> None:
    (tmp_path / "planted.html").write_text(PLANTED)
    page.open(tmp_path / "planted.html")
    assert "https://example.invalid/picture.png" in page.requests
    assert sum("planted" in each for each in page.complaints) >= 1
    assert any("missing is not defined" in each for each in page.complaints)


def test_the_browser_itself_refuses_to_leave_the_page(page: Page, file: Path, tmp_path: Path) -> None:
    text = file.read_text().replace("</main>", '<img src="https://example.invalid/picture.png"></main>')
    (tmp_path / "changed.html").write_text(text)
    page.open(tmp_path / "changed.html")
    assert any("Content Security Policy" in each for each in page.complaints)


def test_the_diagram_comes_first_then_pictures_then_tables(page: Page, file: Path) -> None:
    page.open(file)
    order = "[...document.querySelectorAll('.diagrams, .pictures, table')].map(each => each.className || each.tagName)"
    assert page.value(order)[:3] == ["diagrams", "pictures", "TABLE"]
    assert page.value("document.querySelectorAll('.wide .point').length") == POINTS
    assert page.value("[...document.images].every(each => each.complete && each.naturalWidth > 0)")


@pytest.mark.parametrize(("width", "seen", "hidden"), [(1000, ".wide", ".narrow"), (380, ".narrow", ".wide")])
def test_labels_do_not_overlap_and_nothing_is_too_wide(
    page: Page, file: Path, width: int, seen: str, hidden: str
) -> None:
    """Measured by the browser with the fonts that it has."""
    page.open(file, width)
    assert page.value("document.documentElement.scrollWidth") == width
    assert box(page, f"{seen} .diagram")["width"] > 0.85 * min(width, 960)
    assert box(page, hidden)["width"] == 0
    assert page.value(OVERLAPPING % seen) == 0
    assert page.value(
        f"[...document.querySelectorAll('{seen} .diagram text')].every(each => "
        "parseFloat(getComputedStyle(each).fontSize) >= 11)"
    )


def test_overlapping_labels_would_be_found(page: Page, file: Path, tmp_path: Path) -> None:
    (tmp_path / "moved.html").write_text(
        file.read_text().replace('<g class="name', '<g transform="scale(.5)" class="name')
    )
    page.open(tmp_path / "moved.html")
    assert page.value(OVERLAPPING % ".wide") > 0


def test_it_is_light_or_dark_as_the_user_likes(page: Page, file: Path) -> None:
    page.open(file)
    assert np.median(shown(page)) > 240
    page.open(file, is_dark=True)
    assert np.median(shown(page)) < 40


def test_the_slider_moves_the_border_of_two_pictures(page: Page, file: Path) -> None:
    page.open(file, height=2000)
    panes = box(page, ".panes")
    y = round(panes["y"] + panes["height"] / 2)
    left, right = (round(panes["x"] + share * panes["width"]) for share in (0.3, 0.7))

    def colours() -> list[list[int]]:
        picture = shown(page)
        return [picture[y, x].tolist() for x in (left, right)]

    one, other = colours()
    assert one != other
    page.value("document.querySelector('.comparison input').focus()")
    page.press("End", 35)
    assert colours() == [one, one]
    page.press("Home", 36)
    assert colours() == [other, other]
    page.drag((panes["x"] + 5, y), (panes["x"] + 0.5 * panes["width"], y))
    assert colours() == [one, other]
    assert page.complaints == []


def test_each_picture_can_be_chosen(page: Page, file: Path) -> None:
    page.open(file)
    names = page.value("[...document.querySelectorAll('.pictures img')].map(each => each.alt)")
    assert len(names) == len(ROWS)  # the last row has none, and the reference is one more
    assert page.value("[...document.querySelectorAll('select.left option')].map(each => each.text)") == names
    select = "document.querySelector('select.right')"
    page.value(f"{select}.value = 3; {select}.dispatchEvent(new Event('change'))")
    assert page.value("document.querySelector('.panes .right').alt") == names[3]
    assert page.value(
        "document.querySelector('.panes .right').src === document.querySelectorAll('.pictures img')[3].src"
    )


def test_without_scripts_the_pictures_are_a_grid(page: Page, file: Path) -> None:
    page.run_scripts(False)
    try:
        page.open(file)
        assert box(page, ".comparison")["height"] == 0
        assert box(page, ".pictures")["height"] > 100
        assert page.complaints == []
    finally:
        page.run_scripts(True)


def test_recommended_and_disturbed_rows_stand_out(page: Page, file: Path) -> None:
    page.open(file)
    bright = page.value("[...document.querySelectorAll('.emphasised')].map(each => each.cells[0].textContent)")
    assert bright
    assert set(bright) <= {"uniform", "adaptive", "single"}
    assert page.value("document.querySelectorAll('.wide .line .hollow').length") == 1
    assert page.value("document.querySelectorAll('.wide .line .ring').length") == len(bright)


def test_a_skipped_test_says_how_to_install_a_browser(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(browser.shutil, "which", lambda name: None)
    monkeypatch.delenv("MINIRT_REQUIRE_WINDOW", raising=False)
    with pytest.raises(pytest.skip.Exception, match=r"needs Chromium or Chrome; .*: apt-get install .*chromium"):
        require_browser()
    monkeypatch.setenv("MINIRT_REQUIRE_WINDOW", "1")
    with pytest.raises(pytest.fail.Exception, match="apt-get install"):
        require_browser()
