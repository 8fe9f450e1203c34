"""Screen: compose picture, marks, text and the pages of the help into a frame, and bring it to the window."""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Iterator
from contextlib import suppress
from functools import lru_cache
from itertools import zip_longest
from typing import NamedTuple

import numpy as np

from minirt.mlx import Image, Mlx, Window
from minirt.mlx.canvas import stretch
from minirt.mlx.text import draw_text, measure
from minirt.viewer.bindings import FINE_NOTE, key_groups
from minirt.viewer.display.marks import Marks
from minirt.viewer.display.overlay import (
    MARGIN,
    MESSAGE_COLOUR,
    MIN_TEXT_SIZE,
    TEXT_COLOUR,
    HudLevel,
    Panel,
    draw_hud,
    draw_message,
    draw_panel,
    overlay_scale,
    text_size,
    wrap,
)
from minirt.viewer.display.painter import Outcome, Pixels
from minirt.viewer.editing.state import State

READABLE = 11, 0.7  # least text size, in pixels and as a part of the usual one, before there is another page
INDENT = "  "  # of keys below their title
M_ARENA_MAX = -8  # the parameter of `mallopt` for the number of heaps


class Row(NamedTuple):
    """A row of the table: a title, or keys with their help."""

    keys: str
    help: str = ""


class Column(NamedTuple):
    """Rows below each other, and the widths of their two parts in pixels."""

    rows: list[Row]
    widths: tuple[int, int]


class Help(NamedTuple):
    """The whole table, as it fits a window."""

    size: int  # of the text, in pixels
    pages: list[list[Column]]


def draw_help(pixels: Pixels, layout: str, max_size: int, number: int) -> None:
    """Draw a page of the help, counted from 1, over the darkened picture."""
    pixels >>= 2  # 20 times as fast as the three colours alone
    pixels[..., 3] = 255
    height, width = pixels.shape[:2]
    size, pages = help_pages(layout, width, height, max_size)
    number = min(number, len(pages))
    x = MARGIN
    for rows, widths in pages[number - 1]:
        texts = zip(*rows, strict=True)
        for lines, text_width, colour in zip(texts, widths, (MESSAGE_COLOUR, TEXT_COLOUR), strict=True):
            draw_text(pixels, x, MARGIN, "\n".join(lines), colour, size=size)
            x += text_width
    if len(pages) > 1:
        key = "next page" if number < len(pages) else "back to the picture"
        footer = height - MARGIN // 2 - measure(" ", size)[1]
        draw_text(pixels, MARGIN, footer, f"page {number} of {len(pages)}    H: {key}", MESSAGE_COLOUR, size=size)


@lru_cache(maxsize=4)
def help_pages(layout: str, width: int, height: int, max_size: int) -> Help:
    """Arrange the table with as few pages as readable text allows, in the largest text of so many pages."""
    least = min(max_size, max(READABLE[0], round(READABLE[1] * max_size), MIN_TEXT_SIZE))
    fewest = len(arrange(layout, width, height, least))
    sizes = range(max_size, least - 1, -1)
    arranged = ((size, arrange(layout, width, height, size)) for size in sizes)
    return next(Help(size, pages) for size, pages in arranged if len(pages) <= fewest)


def arrange(layout: str, width: int, height: int, size: int) -> list[list[Column]]:
    """Fill columns from top to bottom, and pages from left to right."""
    line = measure(" ", size)[1]
    capacity = max(3, (height - 2 * MARGIN) // line)
    columns = list(filled_columns(layout, width, size, capacity))
    if sum(map(width_of, columns)) > width - 2 * MARGIN and height > 4 * line:  # several pages: the last line is taken
        columns = list(filled_columns(layout, width, size, max(3, (height - MARGIN * 3 // 2 - line) // line)))
    pages: list[list[Column]] = [[]]
    for column in columns:
        if pages[-1] and sum(map(width_of, (*pages[-1], column))) > width - 2 * MARGIN:
            pages.append([])
        pages[-1].append(column)
    return pages


def filled_columns(layout: str, width: int, size: int, capacity: int) -> Iterator[Column]:
    """Yield columns of at most `capacity` rows; no title is the last row of one."""
    rows: list[Row] = []
    for title, lines in [*key_groups(layout), ("", [FINE_NOTE])]:
        for index, (keys, help) in enumerate(lines):
            block = wrapped(Row(keys, help), width, size)
            if index == 0:
                block = [*([Row("")] if rows else []), *([Row(title)] if title else []), *block]
            if rows and len(rows) + len(block) > capacity:
                yield column_of(rows, size)
                rows, block = [], [row for row in block if row.keys or row.help]
            rows += block
    yield column_of(rows, size)


def wrapped(row: Row, width: int, size: int) -> list[Row]:
    """Return a row whose texts are wrapped where they take more than their share of a narrow window."""
    share = (width - 2 * MARGIN - 2 * size) // 5
    keys, help = (
        wrap(text, part * share + 2 * MARGIN, size).split("\n") for text, part in zip(row, (2, 3), strict=True)
    )
    keys = [INDENT + keys[0].strip(), *(2 * INDENT + line.strip() for line in keys[1:])]
    return [Row(*texts) for texts in zip_longest(keys, help, fillvalue="")]


def column_of(rows: list[Row], size: int) -> Column:
    """Return a column with its widths."""
    keys, helps = ("\n".join(texts) for texts in zip(*rows, strict=True))
    return Column(rows, (measure(keys, size)[0] + size, measure(helps, size)[0] + size))


def width_of(column: Column) -> int:
    """Width of a column in pixels, with the blank to its right."""
    return sum(column.widths)


class Screen:
    """The frame of a window, and the settings of what is drawn over the picture."""

    def __init__(self, mlx: Mlx, window: Window, layout: str) -> None:
        self.mlx = mlx
        self.window = window
        self.layout = layout  # of the keyboard, for the help
        self.level = HudLevel.LINE
        self.help = 0  # its page in the window, counted from 1
        self.text_scale = 1.0  # a factor of the user's
        self.banner = ""  # a message that stays until its reason is gone
        self.panel: Panel | None = None  # a value that is typed, or a list to choose from
        self.marks = Marks()
        self.image = mlx.mlx_new_image(window.display, 1, 1)
        self._drawn: tuple[object, ...] = ()  # the contents of the window

    @property
    def frame(self) -> Pixels:
        """The pixels that were last brought to the window."""
        return self.image.pixels

    @property
    def scale(self) -> float:
        """The scale of text and icons, 1 in a usual window."""
        return overlay_scale(self.window.width, self.window.height, self.window.scale, self.text_scale)

    @property
    def text_size(self) -> int:
        """The size of text, in pixels."""
        return text_size(self.window.width, self.window.height, self.scale)

    def turn_help_page(self) -> None:
        """Show the first page of the help, the next one, or after the last one the picture."""
        pages = help_pages(self.layout, self.window.width, self.window.height, self.text_size).pages
        self.help = self.help + 1 if self.help < len(pages) else 0

    def draw(self, state: State, picture: Outcome | None, rate: float = 0.0) -> bool:
        """Draw a frame unless the window already shows it; return whether it was drawn.

        The words describe `state`, whose scene may be newer than the picture's; the marks fit the picture. `rate`:
        primary rays per second.
        """
        width, height, scale, size = self.window.width, self.window.height, self.scale, self.text_size
        message = state.message or self.banner
        described = state if self.level and not self.help else None
        contents = (
            described,
            picture,
            message,
            self.panel,
            self.level,
            self.help,
            self.marks.icons,
            width,
            height,
            scale,
        )
        if contents == self._drawn:
            return False
        self._drawn = contents
        self.image = Image(self.picture_alone(picture))
        bottom = 0
        if self.help:
            draw_help(self.frame, self.layout, size, self.help)
        elif self.level:
            if picture and (picture.job.width, picture.job.height) == (width, height):  # not an old one, stretched
                self.marks.draw(self.frame, state, picture.job.scene, scale, moving=picture.job.urgent)
            bottom = draw_hud(self.frame, state, picture, self.level, rate, size)
        if self.panel and not self.help:
            draw_panel(self.frame, self.panel, size)
        draw_message(self.frame, message, bottom, size)
        self.mlx.mlx_put_image_to_window(self.window.display, self.window, self.image, 0, 0)
        return True

    def picture_alone(self, picture: Outcome | None) -> Pixels:
        """Return a copy of the picture without overlay, stretched to the window; black if there is no picture yet."""
        width, height = self.window.width, self.window.height
        if picture is None or picture.pixels is None:
            return np.full((height, width, 4), (0, 0, 0, 255), np.uint8)
        same_size = picture.pixels.shape[:2] == (height, width)
        return picture.pixels.copy() if same_size else stretch(picture.pixels, width, height)


def use_one_heap() -> None:
    """Let all threads allocate from one heap, all of which can be given back. Call it before threads start."""
    with suppress(OSError, AttributeError):
        if sys.platform == "linux":
            ctypes.CDLL(None).mallopt(M_ARENA_MAX, 1)


def give_back_memory() -> None:
    """Give the unused pages of the heap back to the system, which takes some milliseconds.

    The frames of a large window return to glibc's heap, between smaller blocks that stay. Without this a window that
    was full screen (2560x1600) once, and is small again, keeps 70 to 110 MB that nothing uses.
    """
    with suppress(OSError, AttributeError):
        if sys.platform == "linux":
            ctypes.CDLL(None).malloc_trim(ctypes.c_size_t(0))
