"""Marks over the picture: outline of the selected shape, axis of its movement, icons of lights."""

from __future__ import annotations

from math import hypot

import numpy as np

from minirt.element import Element
from minirt.mlx.text import draw_text, measure
from minirt.scene import Camera, Scene
from minirt.shapes import Shape
from minirt.viewer.display.edge_arrow import arrow_direction, draw_arrow
from minirt.viewer.display.icons import SIZE, Icon, elements_with_icon, place_icons
from minirt.viewer.display.outline import PixelIndices, outline_pixels
from minirt.viewer.display.painter import Pixels
from minirt.viewer.editing.measure import extent
from minirt.viewer.editing.motion import WORLD_AXES
from minirt.viewer.editing.projection import Pixel, Projection, projection_of
from minirt.viewer.editing.state import Frame, State

GOLD, BLACK, WHITE = 0xFFD75F, 0x000000, 0xFFFFFF
AXIS_COLOURS = {Frame.X: 0xFF5050, Frame.Y: 0x60E060, Frame.Z: 0x6090FF}
MOVING_RAYS, STILL_RAYS = 20_000, 60_000  # rays for an outline, while something moves and when nothing does


class Marks:
    """Draw the marks; the last outline is cached, because it costs a millisecond or two."""

    def __init__(self) -> None:
        self.icons = False  # whether the icons of all lights are shown
        self._outline_key: tuple[object, ...] = ()
        self._outline: tuple[PixelIndices, PixelIndices]

    def draw(self, pixels: Pixels, state: State, scene: Scene, scale: float, moving: bool) -> None:
        """Draw all marks over a picture of `scene`, which may be another version of the state's scene.

        The marks fit the picture: an element that it does not show yet has none.
        """
        view = projection_of(scene.camera, pixels.shape[1], pixels.shape[0])
        selected = state.index_in(scene)
        if selected is not None:
            element = scene.elements[selected]
            if isinstance(element, Shape):
                rays = MOVING_RAYS if moving else STILL_RAYS
                draw_outline(pixels, *self.outline(element, scene.camera, pixels, rays))
            draw_axis(pixels, element, state.frame, view)
            around = None if isinstance(element, Camera) else extent(element)
            outside = arrow_direction(view, *around) if around else None
            if outside and not (isinstance(element, Shape) and element.infinite):
                draw_arrow(pixels, outside, scale)
        for icon in self.visible_icons(scene, selected, view, scale):
            draw_icon(pixels, icon, scale, selected=icon.owner == selected)

    def outline(self, shape: Shape, camera: Camera, pixels: Pixels, rays: int) -> tuple[PixelIndices, PixelIndices]:
        """Return the pixels just outside and just inside the silhouette of a shape."""
        height, width = pixels.shape[:2]
        key = (shape, camera, width, height, rays)
        if key != self._outline_key:
            self._outline, self._outline_key = outline_pixels(shape, camera, width, height, rays), key
        return self._outline

    def visible_icons(self, scene: Scene, selected: int | None, view: Projection, scale: float) -> list[Icon]:
        """Return the icons that are shown: all if the user wants them, else that of the selected element."""
        return place_icons(scene, icon_owners(scene, selected, self.icons), view, scale)


def icon_owners(scene: Scene, selected: int | None, every: bool) -> list[int]:
    """Return the indices of the elements whose icons are shown."""
    if every:
        return elements_with_icon(scene)
    if selected is None or isinstance(scene.elements[selected], (Shape, Camera)):
        return []
    return [selected]


def draw_outline(pixels: Pixels, outside: PixelIndices, inside: PixelIndices) -> None:
    """Draw a golden line, two pixels wide, with a black line on either side for contrast with any colour."""
    height, width = pixels.shape[:2]
    for rows, columns in (outside, inside):
        for down, right in ((-1, 0), (1, 0), (0, -1), (0, 1)):
            around = np.clip(rows + down, 0, height - 1), np.clip(columns + right, 0, width - 1)
            pixels[around] = bgra(BLACK)
    pixels[inside] = pixels[outside] = bgra(GOLD)


def draw_axis(pixels: Pixels, element: Element, frame: Frame, view: Projection) -> None:
    """Draw the axis along which the selected element moves, if its movement is bound to one."""
    axis, point = WORLD_AXES.get(frame), anchor(element)
    ends = view.visible_segment(point, axis) if axis and point else None
    if ends:
        draw_line(pixels, *ends, AXIS_COLOURS[frame])


def anchor(element: Element) -> tuple[float, float, float] | None:
    """Return the centre of an element, None for the camera and for elements without a position."""
    around = None if isinstance(element, Camera) else extent(element)
    return around[0] if around else None


def draw_line(pixels: Pixels, start: Pixel, end: Pixel, colour: int) -> None:
    """Draw a line, two pixels wide, between two points inside or outside the picture.

    The line is clipped to the picture by the algorithm of Liang and Barsky (1984).
    """
    height, width = pixels.shape[:2]
    (x, y), (dx, dy) = start, (end[0] - start[0], end[1] - start[1])
    low, high = 0.0, 1.0  # the part of the line within the picture
    for direction, distance in ((-dx, x), (dx, width - 1 - x), (-dy, y), (dy, height - 1 - y)):
        if direction == 0 and distance < 0:
            return
        if direction < 0:
            low = max(low, distance / direction)
        elif direction > 0:
            high = min(high, distance / direction)
    if low > high:
        return
    at = np.linspace(low, high, int((high - low) * hypot(dx, dy)) + 2)
    columns, rows = np.round(x + at * dx).astype(np.int64), np.round(y + at * dy).astype(np.int64)
    pixels[rows, columns] = bgra(colour)
    steep = abs(dy) > abs(dx)
    pixels[np.minimum(rows + (not steep), height - 1), np.minimum(columns + steep, width - 1)] = bgra(colour)


def draw_icon(pixels: Pixels, icon: Icon, scale: float, selected: bool) -> None:
    """Draw a square in the element's colour with its identifier; the frame is golden if it is selected."""
    half, frame = round(SIZE * scale / 2), max(1, round(2 * scale))
    fill_square(pixels, icon, half + frame, GOLD if selected else BLACK)
    fill_square(pixels, icon, half, icon.colour)
    bright = sum(icon.colour >> shift & 0xFF for shift in (0, 8, 16)) > 3 * 110
    size = round(14 * scale)
    width, height = measure(icon.code, size)
    draw_text(pixels, icon.x - width // 2, icon.y - height // 2, icon.code, BLACK if bright else WHITE, size=size)


def fill_square(pixels: Pixels, icon: Icon, half: int, colour: int) -> None:
    """Fill a square around the centre of an icon; `half` is half its side, in pixels."""
    left, top = max(0, icon.x - half), max(0, icon.y - half)
    pixels[top : max(0, icon.y + half), left : max(0, icon.x + half)] = bgra(colour)


def bgra(colour: int) -> tuple[int, int, int, int]:
    """Convert 0xRRGGBB to an opaque pixel: blue, green, red, alpha."""
    return colour & 0xFF, colour >> 8 & 0xFF, colour >> 16 & 0xFF, 255
