"""Pages of the help: the table of keys, grouped by what one wants to do, in columns that fit the window."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from itertools import zip_longest

from minirt.mlx.text import draw_text, measure
from minirt.viewer.bindings import key_groups
from minirt.viewer.display import overlay
from minirt.viewer.display.jobs import Pixels
from minirt.viewer.display.overlay import MARGIN, MESSAGE_COLOUR, MIN_TEXT_SIZE, TEXT_COLOUR, wrap
from minirt.viewer.language import translated

READABLE = 11, 0.7  # least text size, in pixels and as a part of the usual one, before there is another page
INDENT = "  "  # of keys below their title
Column = tuple[str, str]  # lines of keys, titles among them, and of their help


def draw_help(pixels: Pixels, layout: str, search: str, max_size: int, number: int) -> None:
    """Draw page `number` of the help, counted from 1, over the darkened picture: the rows that contain `search`.

    Without so many pages it is the last one. layout: of the keyboard. max_size: of the text, in pixels.
    """
    pixels >>= 2  # all four bytes, 20 times as fast as the three colours alone
    pixels[..., 3] = 255  # opaque again
    height, width = pixels.shape[:2]
    size, pages = help_pages(layout, search, width, height, max_size)
    number = min(number, len(pages))
    x = MARGIN
    for column in pages[number - 1]:
        for text, colour in zip(column, (MESSAGE_COLOUR, TEXT_COLOUR), strict=True):
            x += draw_text(pixels, x, MARGIN, text, colour, size=size)[0] + size
    footer = f"search: {search}_" if search else "type to search    Esc, H, click: back to the picture"
    if len(pages) > 1:
        footer += f"    page {number} of {len(pages)}: arrows, wheel"
    line = overlay.fit_width(translated(footer), width, size)
    draw_text(pixels, MARGIN, height - MARGIN // 2 - measure(line, size)[1], line, MESSAGE_COLOUR, size=size)


@lru_cache(maxsize=8)
def help_pages(layout: str, search: str, width: int, height: int, max_size: int) -> tuple[int, list[list[Column]]]:
    """Arrange the table with as few pages as readable text allows, in the largest text of so many pages.

    Returns the size of the text in pixels, and the columns of each page.
    """
    least = min(max_size, max(READABLE[0], round(READABLE[1] * max_size), MIN_TEXT_SIZE))
    fewest = len(arrange(layout, search, width, height, least))
    arranged = ((size, arrange(layout, search, width, height, size)) for size in range(max_size, least - 1, -1))
    return next((size, pages) for size, pages in arranged if len(pages) <= fewest)


def arrange(layout: str, search: str, width: int, height: int, size: int) -> list[list[Column]]:
    """Fill columns from top to bottom, and pages from left to right; the last line of a page says how to go on."""
    line = measure(" ", size)[1]
    columns = filled_columns(layout, search, width, size, (height - MARGIN * 3 // 2 - line) // line)
    pages: list[list[Column]] = [[]]
    for column in columns:
        if pages[-1] and width_of([*pages[-1], column], size) > width - 2 * MARGIN:
            pages.append([])
        pages[-1].append(column)
    return pages


def filled_columns(layout: str, search: str, width: int, size: int, capacity: int) -> Iterator[Column]:
    """Yield columns of at most `capacity` lines, or of 3 if that is less, in text of `size` pixels.

    No column ends with a title. `layout` of the keyboard, and `search`, are those of `draw_help`.
    """
    lines: list[tuple[str, str]] = []
    for title, rows in key_groups(layout, search, translated):
        for index, row in enumerate(rows):
            block = wrapped(row, width, size)
            if index == 0:
                gap = [("", "")] if lines else []
                heading = [(title, "")] if title else []
                block = [*gap, *heading, *block]
            if lines and len(lines) + len(block) > max(3, capacity):
                yield joined(lines)
                lines, block = [], [line for line in block if any(line)]  # a column begins without a gap
            lines += block
    yield joined(lines)


def wrapped(row: tuple[str, str], width: int, size: int) -> list[tuple[str, str]]:
    """Return the lines of a row whose texts are wrapped where they take more than their share of a narrow window."""
    share = (width - 2 * MARGIN - 2 * size) // 5
    widths = (part * share + 2 * MARGIN for part in (2, 3))
    keys, help = (wrap(text, each, size).split("\n") for text, each in zip(row, widths, strict=True))
    keys = [INDENT + keys[0].strip(), *(2 * INDENT + line.strip() for line in keys[1:])]
    return list(zip_longest(keys, help, fillvalue=""))


def joined(lines: list[tuple[str, str]]) -> Column:
    """Return lines as a column."""
    return "\n".join(keys for keys, _ in lines), "\n".join(help for _, help in lines)


def width_of(columns: list[Column], size: int) -> int:
    """Width of columns in pixels, with the blanks to their right."""
    return sum(measure(text, size)[0] + size for column in columns for text in column)
