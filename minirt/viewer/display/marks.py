"""What is drawn over the picture: the outline of the selected shape, the axis it is moved along, icons."""

from __future__ import annotations

from math import hypot

import numpy as np

from minirt.element import Element
from minirt.mlx.text import draw_text, measure
from minirt.scene import Camera, Scene
from minirt.shapes import Shape
from minirt.viewer.display.icons import SIZE, Icon, icons, signed
from minirt.viewer.display.outline import Places, rims
from minirt.viewer.display.painter import Pixels
from minirt.viewer.editing.measure import extent
from minirt.viewer.editing.motion import WORLD_AXES
from minirt.viewer.editing.projection import Pixel, Projection, projection_of
from minirt.viewer.editing.state import Frame, State

GOLD, BLACK = 0xFFD75F, 0x000000
AXES = {Frame.X: 0xFF5050, Frame.Y: 0x60E060, Frame.Z: 0x6090FF}
QUICK, CAREFUL = 20_000, 60_000  # rays for an outline: while something moves, and when nothing does


class Marks:
    """Remembers the last outline, which costs a millisecond or two."""

    def __init__(self) -> None:
        self.icons = False  # whether all of them are shown
        self._outlined: tuple[object, ...] = ()
        self._rims: tuple[Places, Places]

    def draw(self, pixels: Pixels, state: State, scale: float, moving: bool) -> None:
        """Draw all of it over the picture of the state's scene."""
        seen = projection_of(state.scene.camera, pixels.shape[1], pixels.shape[0])
        element = state.element
        if isinstance(element, Shape):
            draw_outline(pixels, *self.outline(element, state.scene.camera, pixels, QUICK if moving else CAREFUL))
        draw_axis(pixels, state, seen)
        for icon in self.placed(state, seen, scale):
            draw_icon(pixels, icon, scale, chosen=icon.owner == state.selected)

    def outline(self, shape: Shape, camera: Camera, pixels: Pixels, rays: int) -> tuple[Places, Places]:
        """Pixels outside and inside of it."""
        height, width = pixels.shape[:2]
        wanted = (shape, camera, width, height, rays)
        if wanted != self._outlined:
            self._rims, self._outlined = rims(shape, camera, width, height, rays), wanted
        return self._rims

    def placed(self, state: State, seen: Projection, scale: float) -> list[Icon]:
        """The icons that are shown: all where they are wanted, else that of the selected element."""
        return icons(state.scene, indices(state.scene, state.selected, self.icons), seen, scale)


def indices(scene: Scene, selected: int, every: bool) -> list[int]:
    """Of the elements whose icons are shown."""
    if every:
        return signed(scene)
    element = scene.elements[selected]
    return [] if isinstance(element, (Shape, Camera)) else [selected]


def draw_outline(pixels: Pixels, outside: Places, inside: Places) -> None:
    """A line of two pixels with a dark one on either side, to be seen on any colour."""
    height, width = pixels.shape[:2]
    for rows, columns in (outside, inside):
        for down, right in ((-1, 0), (1, 0), (0, -1), (0, 1)):
            around = np.clip(rows + down, 0, height - 1), np.clip(columns + right, 0, width - 1)
            pixels[around] = blue_first(BLACK)
    pixels[inside] = pixels[outside] = blue_first(GOLD)


def draw_axis(pixels: Pixels, state: State, seen: Projection) -> None:
    """The axis that the selected element moves along, where it moves along one."""
    axis, around = WORLD_AXES.get(state.frame), anchor(state.element)
    ends = seen.visible_segment(around, axis) if axis and around else None
    if ends:
        draw_line(pixels, *ends, AXES[state.frame])


def anchor(element: Element) -> tuple[float, float, float] | None:
    """Where an element is, None for the camera and for what is nowhere."""
    around = None if isinstance(element, Camera) else extent(element)
    return around[0] if around else None


def draw_line(pixels: Pixels, start: Pixel, end: Pixel, colour: int) -> None:
    """A line between two points of the picture or beside it, two pixels wide."""
    height, width = pixels.shape[:2]
    (x, y), (dx, dy) = start, (end[0] - start[0], end[1] - start[1])
    low, high = 0.0, 1.0  # the part of it that is in the picture (Liang and Barsky)
    for way, room in ((-dx, x), (dx, width - 1 - x), (-dy, y), (dy, height - 1 - y)):
        if way == 0 and room < 0:
            return
        if way < 0:
            low = max(low, room / way)
        elif way > 0:
            high = min(high, room / way)
    if low > high:
        return
    at = np.linspace(low, high, int((high - low) * hypot(dx, dy)) + 2)
    columns, rows = np.round(x + at * dx).astype(np.int64), np.round(y + at * dy).astype(np.int64)
    pixels[rows, columns] = blue_first(colour)
    steep = abs(dy) > abs(dx)
    pixels[np.minimum(rows + (not steep), height - 1), np.minimum(columns + steep, width - 1)] = blue_first(colour)


def draw_icon(pixels: Pixels, icon: Icon, scale: float, chosen: bool) -> None:
    """A square in the element's colour with its identifier, framed where it is selected."""
    half, frame = round(SIZE * scale / 2), max(1, round(2 * scale))
    fill(pixels, icon, half + frame, GOLD if chosen else BLACK)
    fill(pixels, icon, half, icon.colour)
    bright = sum(icon.colour >> shift & 0xFF for shift in (0, 8, 16)) > 3 * 110
    size = max(8, round(14 * scale))
    width, height = measure(icon.code, size)
    draw_text(pixels, icon.x - width // 2, icon.y - height // 2, icon.code, BLACK if bright else 0xFFFFFF, size=size)


def fill(pixels: Pixels, icon: Icon, half: int, colour: int) -> None:
    """A square around the middle of an icon."""
    left, top = max(0, icon.x - half), max(0, icon.y - half)
    pixels[top : max(0, icon.y + half), left : max(0, icon.x + half)] = blue_first(colour)


def blue_first(colour: int) -> tuple[int, int, int, int]:
    """0xRRGGBB as an opaque pixel."""
    return colour & 0xFF, colour >> 8 & 0xFF, colour >> 16 & 0xFF, 255
