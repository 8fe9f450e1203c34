"""Tool row at the left edge of the window: buttons for what one does most, with their names while the pointer is there.

Icons are drawn from strokes, as text is from its font: in any size, and with soft edges.
"""

from __future__ import annotations

from functools import lru_cache
from math import cos, pi, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.mlx.canvas import blend
from minirt.mlx.text import measure
from minirt.viewer.bindings import keys_of
from minirt.viewer.display.jobs import Pixels
from minirt.viewer.display.lists import PADDING, TITLE_COLOUR, darken, draw_on_dark
from minirt.viewer.editing.handles import MOVE, SIZE, TURN
from minirt.viewer.language import GAP, translated

Stroke = tuple[tuple[float, float], ...]  # corners, right and down in a square from 0 to 1

SIDE = 30  # pixels of a button, times the scale
ICON = 0.6  # of the side
ROOM = 36  # pixels above and below the row, times the scale
LEAST = 14, 200  # pixels: the smallest button, and the narrowest window with a tool row
COLOUR, USED = 0xE0E0E0, TITLE_COLOUR
FINER = 4  # times the size in which an icon is drawn
WIDTH = 0.09  # of a stroke, as a share of the icon


def arc(start: float, end: float, radius: float = 0.34, y: float = 0.5) -> Stroke:
    """Return an arc around the middle of an icon, counter-clockwise from the right, in degrees."""
    angles = (pi / 180 * (start + (end - start) * step / 16) for step in range(17))
    return tuple((0.5 + radius * cos(angle), y - radius * sin(angle)) for angle in angles)


class Tool(NamedTuple):
    """A button: the action of the table that a click performs, or the kind of handles that it shows alone."""

    name: str
    strokes: tuple[Stroke, ...]
    action: str = ""
    handles: str = ""


UPRIGHT, LEVEL = ((0.5, 0.06), (0.5, 0.94)), ((0.06, 0.5), (0.94, 0.5))
HEADS = (
    ((0.38, 0.2), (0.5, 0.06), (0.62, 0.2)),
    ((0.38, 0.8), (0.5, 0.94), (0.62, 0.8)),
    ((0.2, 0.38), (0.06, 0.5), (0.2, 0.62)),
    ((0.8, 0.38), (0.94, 0.5), (0.8, 0.62)),
)
SQUARE = ((0.1, 0.5), (0.5, 0.5), (0.5, 0.9), (0.1, 0.9), (0.1, 0.5))
GROWING = SQUARE, ((0.5, 0.5), (0.88, 0.12)), ((0.6, 0.12), (0.88, 0.12), (0.88, 0.4))
BACK = arc(-30, 180, 0.36, 0.6), ((0.0, 0.4), (0.14, 0.6), (0.34, 0.46))
FORTH = tuple(tuple((1 - x, y) for x, y in stroke) for stroke in BACK)
DOWN = ((0.5, 0.06), (0.5, 0.6)), ((0.3, 0.42), (0.5, 0.62), (0.7, 0.42))
TRAY = ((0.1, 0.6), (0.1, 0.9), (0.9, 0.9), (0.9, 0.6))
QUESTION = (*arc(170, 0, 0.24, 0.3), *arc(0, -80, 0.24, 0.3), (0.5, 0.68)), ((0.5, 0.86), (0.5, 0.9))

TOOLS = (
    Tool("add an element", (((0.5, 0.1), (0.5, 0.9)), ((0.1, 0.5), (0.9, 0.5))), "add"),
    Tool("handles that move", (UPRIGHT, LEVEL, *HEADS), handles=MOVE),
    Tool("handles that turn", (arc(30, 330), ((0.62, 0.62), (0.8, 0.68), (0.88, 0.5))), handles=TURN),
    Tool("handles that resize", GROWING, handles=SIZE),
    Tool("undo", BACK, "undo"),
    Tool("redo", FORTH, "redo"),
    Tool("save the scene", (*DOWN, TRAY), "save"),
    Tool("help", QUESTION, "toggle help"),
)


def layout(width: int, height: int, scale: float) -> tuple[int, int]:
    """Return the side of a button in pixels and the top of the row; a side of 0 where a window has no room for it."""
    side = int(min(SIDE * scale, (height - 2 * ROOM * scale) / len(TOOLS)))
    has_room = side >= LEAST[0] and width >= LEAST[1]
    return (side, (height - side * len(TOOLS)) // 2) if has_room else (0, 0)


def reach(width: int, height: int, scale: float, text: int) -> int:
    """Return how far the row reaches from the left into text of so many pixels at the bottom of a window."""
    side, top = layout(width, height, scale)
    return side if top + side * len(TOOLS) > height - text - 3 * PADDING else 0


def tool_at(x: int, y: int, width: int, height: int, scale: float) -> Tool | None:
    """Return the tool at a pixel of a window of that size."""
    side, top = layout(width, height, scale)
    is_on_row = 0 <= x < side and top <= y < top + side * len(TOOLS)
    return TOOLS[(y - top) // side] if is_on_row else None


def draw_tools(pixels: Pixels, scale: float, size: int, hovered: Tool | None, handles: str, keyboard: str) -> None:
    """Draw the tool row; nothing where the window has no room for it.

    `hovered`: the tool under the pointer, whose name is shown in text of `size` pixels, with its key on a `keyboard`
    layout. `handles`: the kind of handles that is shown alone, "" for all.
    """
    height, width = pixels.shape[:2]
    side, top = layout(width, height, scale)
    if not side:
        return
    darken(pixels, 0, top, side, top + side * len(TOOLS))
    icon = round(ICON * side)
    for number, tool in enumerate(TOOLS):
        is_used = tool is hovered or bool(handles and tool.handles == handles)
        left, upper = (side - icon) // 2, top + number * side + (side - icon) // 2
        below = pixels.view("<u4")[upper : upper + icon, left : left + icon, 0]
        blend(below, coverage(tool, icon) | np.uint32(USED if is_used else COLOUR))
        if tool is hovered:
            name = translated(GAP.join((tool.name, *keys_of(tool.action, keyboard)[:1])))
            middle = top + number * side + (side - measure(name, size)[1]) // 2
            draw_on_dark(pixels, side + 2 * PADDING, middle, name, TITLE_COLOUR, size=size)


@lru_cache(maxsize=64)
def coverage(tool: Tool, size: int) -> NDArray[np.uint32]:
    """Return the coverage of each pixel by the strokes of a tool, in the bits of alpha."""
    from PIL import Image, ImageDraw

    image = Image.new("L", (FINER * size, FINER * size))
    draw = ImageDraw.Draw(image)
    for stroke in tool.strokes:
        points = [(FINER * size * x, FINER * size * y) for x, y in stroke]
        draw.line(points, fill=255, width=max(1, round(WIDTH * FINER * size)), joint="curve")
    return np.asarray(image.resize((size, size), Image.Resampling.BOX)).astype(np.uint32) << np.uint32(24)
