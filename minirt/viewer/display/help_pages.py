"""Help: the table of key bindings over the darkened picture, in as many columns and pages as the window needs."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from itertools import zip_longest
from typing import NamedTuple

from minirt.mlx.text import draw_text, measure
from minirt.viewer.bindings import FINE_NOTE, key_groups
from minirt.viewer.display.overlay import MARGIN, MESSAGE_COLOUR, MIN_TEXT_SIZE, TEXT_COLOUR, wrap
from minirt.viewer.display.painter import Pixels

READABLE = 11, 0.7  # least text size, in pixels and as a part of the usual one, before there is another page
INDENT = "  "  # of keys below their title


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
