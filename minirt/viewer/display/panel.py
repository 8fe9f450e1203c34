"""Panel over the picture: a value that is typed, or a list to choose from."""

from __future__ import annotations

from typing import NamedTuple

from minirt.mlx.text import draw_text, measure
from minirt.viewer.display.painter import Pixels

TEXT_COLOUR, TITLE_COLOUR = 0xC0C0C0, 0xFFD75F
BACKGROUND = 0xC0000000  # with its opacity
MARGIN, PADDING = 10, 4  # pixels
TOP, BOTTOM = 2, 2  # lines above and below the panel, which belong to the information and to messages
MARK = "> "  # before the chosen row


class Panel(NamedTuple):
    """A title with rows below, of which one is chosen."""

    title: str
    rows: tuple[str, ...] = ()
    chosen: int = 0


def draw_panel(pixels: Pixels, panel: Panel, size: int) -> None:
    """Draw a panel in text of a size, above the messages; of a long list the rows around the chosen one."""
    line = measure(" ", size)[1]
    top = MARGIN + TOP * line
    draw_line(pixels, MARGIN, top, panel.title, TITLE_COLOUR, size)
    count = max(1, (pixels.shape[0] - MARGIN - 2 * PADDING - top) // line - 1 - BOTTOM)
    first = min(max(panel.chosen - count // 2, 0), max(len(panel.rows) - count, 0))
    rows = panel.rows[first : first + count]
    if rows:
        top, left = top + line + 2 * PADDING, MARGIN + measure(MARK, size)[0]
        draw_line(pixels, left, top, "\n".join(rows), TEXT_COLOUR, size)
        chosen = panel.chosen - first
        draw_text(pixels, MARGIN, top + chosen * line, MARK, TITLE_COLOUR, size=size)
        draw_text(pixels, left, top + chosen * line, rows[chosen], TITLE_COLOUR, size=size)


def draw_line(pixels: Pixels, x: int, y: int, text: str, colour: int, size: int) -> None:
    """Draw text on a dark ground."""
    draw_text(pixels, x, y, text, colour, size=size, background=BACKGROUND, padding=PADDING)
