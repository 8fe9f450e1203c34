"""Lists over the picture: a title with rows below, drawn by the window itself, and which row a pixel is on."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from minirt.mlx import Button
from minirt.mlx.canvas import blend
from minirt.mlx.text import draw_text, measure
from minirt.viewer.display.jobs import Pixels
from minirt.viewer.language import translated

TITLE_COLOUR, ROW_COLOUR = 0xFFD75F, 0xC0C0C0  # also of the chosen row, and of the others
BACKGROUND = 0xC0000000  # with its opacity
MARGIN, PADDING = 10, 4  # pixels
TOP, BOTTOM = 2, 2  # lines above and below a list, which belong to the information and to messages
WHEEL: dict[int, int] = {Button.WHEEL_UP: -1, Button.WHEEL_DOWN: 1}  # rows that a turn goes on in a list
MARK = "> "  # before the chosen row

draw_on_dark = partial(draw_text, background=BACKGROUND, padding=PADDING)


class ListBox(NamedTuple):
    """A title with rows below, of which one is chosen."""

    title: str
    rows: tuple[str, ...] = ()
    chosen: int = 0
    keys: tuple[str, ...] = ()  # of the rows, in a column at their right
    place: tuple[int, int] | None = None  # pixel of its upper left corner; None: below the information
    left: int = MARGIN  # border there, in pixels
    is_right: bool = False  # whether it is at the right, if it is below the information


class Layout(NamedTuple):
    """Where a list is in a window, in pixels; of a long list only the rows around the chosen one are shown."""

    left: int  # of the title; rows are behind the mark
    top: int
    text_left: int
    keys_left: int
    rows_top: int
    line: int  # height of a row
    first: int  # the first row that is shown
    shown: int  # number of rows that are shown
    right: int

    def row_at(self, x: int, y: int) -> int | None:
        """Return the index of the row at a pixel, None beside the rows."""
        number = (y - self.rows_top) // self.line
        is_on_row = self.left <= x < self.right and 0 <= number < self.shown
        return self.first + number if is_on_row else None


def layout_of(box: ListBox, width: int, height: int, size: int) -> Layout:
    """Arrange a list in a picture of width by height pixels, in text of `size` pixels. At least one row is shown, even
    where there is no room."""
    line, mark = measure(" ", size)[1], measure(MARK, size)[0]
    rows_width, keys_width = (measure("\n".join(column), size)[0] for column in translations(box))
    breadth = mark + rows_width + (keys_width + 4 * PADDING if keys_width else 0)
    head = line + 2 * PADDING  # height of the title
    widest = max(breadth, measure(translated(box.title), size)[0])
    if box.place is None:
        left = max(MARGIN, width - MARGIN - widest) if box.is_right else box.left
        top = MARGIN + TOP * line
        most = (height - MARGIN - 2 * PADDING - top) // line - 1 - BOTTOM
    else:
        most = (height - 2 * MARGIN - head) // line
        tall = head + min(len(box.rows), max(1, most)) * line
        left = max(MARGIN, min(box.place[0], width - MARGIN - widest))
        top = max(MARGIN, min(box.place[1], height - MARGIN - tall))
    count = min(len(box.rows), max(1, most))
    first = min(max(box.chosen - count // 2, 0), len(box.rows) - count)
    text_left = left + mark
    keys_left = left + breadth - keys_width
    return Layout(left, top, text_left, keys_left, top + head, line, first, count, left + breadth)


def darken(pixels: Pixels, left: int, top: int, right: int, bottom: int) -> None:
    """Lay the background of lists over a rectangle, clipped at the borders."""
    below = pixels.view("<u4")[max(0, top) : max(0, bottom), max(0, left) : max(0, right), 0]
    if below.size:
        blend(below, np.full(below.shape, BACKGROUND, np.uint32))


def translations(box: ListBox) -> tuple[list[str], list[str]]:
    """Return rows and keys in the user's language."""
    return [translated(row) for row in box.rows], list(box.keys)


def draw_list(pixels: Pixels, box: ListBox, size: int) -> None:
    """Draw a list, in text of `size` pixels."""
    at = layout_of(box, pixels.shape[1], pixels.shape[0], size)
    draw_on_dark(pixels, at.left, at.top, translated(box.title), TITLE_COLOUR, size=size)
    in_sight = slice(at.first, at.first + at.shown)
    rows, keys = (column[in_sight] for column in translations(box))
    if rows:
        bottom = at.rows_top + at.shown * at.line
        darken(pixels, at.left - PADDING, at.rows_top - PADDING, at.right + PADDING, bottom + PADDING)
        draw_text(pixels, at.text_left, at.rows_top, "\n".join(rows), ROW_COLOUR, size=size)
        draw_text(pixels, at.keys_left, at.rows_top, "\n".join(keys), ROW_COLOUR, size=size)
        chosen_top = at.rows_top + (box.chosen - at.first) * at.line
        draw_text(pixels, at.left, chosen_top, MARK, TITLE_COLOUR, size=size)
        draw_text(pixels, at.text_left, chosen_top, rows[box.chosen - at.first], TITLE_COLOUR, size=size)
