"""Pages of the help: every row is shown, readable and within the window, whatever its size."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from minirt.mlx import Key
from minirt.mlx.text import measure
from minirt.viewer.bindings import BINDINGS, FINE_NOTE
from minirt.viewer.display import help_pages
from minirt.viewer.display.help_pages import draw_help, width_of
from minirt.viewer.display.overlay import overlay_scale, text_size
from tests.viewer.session_harness import SessionHarness

SIZES = [(320, 240), (640, 480), (1280, 720), (1900, 300), (3840, 2160)]
DARK = 255 // 4


def table(width: int, height: int) -> help_pages.Help:
    """Return the help of a window of that size."""
    return help_pages.help_pages("qwerty", width, height, text_size(width, height, overlay_scale(width, height, 1, 1)))


def drawn(width: int, height: int, number: int) -> NDArray[np.uint8]:
    """Draw a page over a white picture."""
    pixels = np.full((height, width, 4), 255, np.uint8)
    draw_help(pixels, "qwerty", text_size(width, height, overlay_scale(width, height, 1, 1)), number)
    return pixels


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_every_row_is_on_some_page(width: int, height: int) -> None:
    rows = [row for page in table(width, height).pages for column in page for row in column.rows]
    shown = " ".join(row.help for row in rows).split()
    texts = [*(binding.help for binding in BINDINGS), FINE_NOTE[1]]
    assert shown == " ".join(texts).split()
    assert {row.keys.strip() for row in rows} >= {"Left", "Shift+Tab", "Select", "Window"}


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_all_pages_fit_the_window(width: int, height: int) -> None:
    size, pages = table(width, height)
    for page in pages:
        assert sum(map(width_of, page)) <= width
        assert all(len(column.rows) * measure(" ", size)[1] <= height for column in page)
        assert not any(column.rows[-1].keys and not column.rows[-1].help for column in page)  # a title


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_the_text_is_within_the_window_and_does_not_overlap(width: int, height: int) -> None:
    size, pages = table(width, height)
    for number in range(1, len(pages) + 1):
        lit = (drawn(width, height, number)[..., :3] > DARK).any(axis=2)
        assert lit.any()
        assert not lit[:, -4:].any()
        assert not lit[-2:].any()
        used = max(len(column.rows) for column in pages[number - 1]) * measure(" ", size)[1] + 10
        footer = height - 5 - measure(" ", size)[1]
        assert len(pages) == 1 or used <= footer + size // 3  # the last line's blank below may be used
        assert len(pages) > 1 or used <= height


@pytest.mark.parametrize(("size", "pages", "least"), [((320, 240), 8, 11), ((640, 480), 3, 11), ((1280, 720), 1, 13)])
def test_there_are_few_pages_of_readable_text(size: tuple[int, int], pages: int, least: int) -> None:
    shown = table(*size)
    assert len(shown.pages) <= pages
    assert shown.size >= least


@pytest.mark.parametrize(("width", "height"), [(200, 100), (40, 300), (1, 1)])
def test_tiny_windows_have_some_help(width: int, height: int) -> None:
    for number in (1, 5, 10**6):
        assert drawn(width, height, number)[..., :3].min() == DARK


def test_the_key_turns_the_pages_and_ends_with_the_picture() -> None:
    harness = SessionHarness()
    session = harness.session
    harness.memory.resize(320, 240)
    harness.memory.play()
    last = len(table(320, 240).pages)
    assert last > 1
    for page in [*range(1, last + 1), 0, 1]:
        harness.tap(Key.H)
        assert session.screen.help == page
