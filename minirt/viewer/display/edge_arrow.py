"""Arrow at the edge of the picture, towards a selected element that lies outside of it."""

from __future__ import annotations

from math import hypot

import numpy as np

from minirt.fields import Triple
from minirt.viewer.display.painter import Pixels
from minirt.viewer.editing.projection import Projection, dot, subtract

LENGTH, BORDER, TOP = 18, 8, 36  # pixels: of the arrow, and of room for it at the edge and at the top; times the scale
FILL, RIM = (0x5F, 0xD7, 0xFF, 255), (0, 0, 0, 255)  # BGRA: golden, with a black rim


def arrow_direction(view: Projection, point: Triple, radius: float = 0.0) -> tuple[float, float] | None:
    """Unit direction in the picture, right and down, towards a ball outside of it; None if it is inside."""
    depth = view.depth(point)
    offset = subtract(point, view.eye)
    across, up = dot(offset, view.right) / hypot(*view.right), dot(offset, view.up) / hypot(*view.up)
    at = view.pixel(point)
    if at and depth > 0:
        reach = view.width / 2 / hypot(*view.right) * radius / depth
        if -reach <= at[0] < view.width + reach and -reach <= at[1] < view.height + reach:
            return None
    elif hypot(*offset) <= radius:
        return None
    length = hypot(across, up)
    return (across / length, -up / length) if length else (0.0, 1.0)


def draw_arrow(pixels: Pixels, direction: tuple[float, float], scale: float) -> None:
    """Draw an arrow whose tip is where a line from the picture's middle in this direction meets its border."""
    height, width = pixels.shape[:2]
    border, top = min(BORDER * scale, width / 4, height / 8), min(TOP * scale, height / 4)
    room = width / 2 - border, (height - border - top) / 2
    reach = min(side / abs(part) for side, part in zip(room, direction, strict=True) if part)
    tip = width / 2 + reach * direction[0], top + room[1] + reach * direction[1]
    size = LENGTH * scale
    y, x = np.ogrid[:height, :width]
    along = (tip[0] - x - 0.5) * direction[0] + (tip[1] - y - 0.5) * direction[1]  # back from the tip
    beside = np.abs((x + 0.5 - tip[0]) * direction[1] - (y + 0.5 - tip[1]) * direction[0])
    pixels[(along >= -2 * scale) & (along <= size + 2 * scale) & (beside <= along / 2 + 3 * scale)] = RIM
    pixels[(along >= 0) & (along <= size) & (beside <= along / 2)] = FILL
