"""Marks over the picture: outline of the selected shape, axis of its movement, icons, an arrow to what is outside."""

from __future__ import annotations

from collections.abc import Iterable
from math import hypot
from typing import NamedTuple

import numpy as np

from minirt.element import Element, fields_of
from minirt.fields import Colour, Triple
from minirt.mlx.text import draw_text, measure
from minirt.scene import Camera, Scene
from minirt.scene.registry import ELEMENTS
from minirt.shapes import Shape
from minirt.viewer.display.outline import PixelIndices, outline_pixels
from minirt.viewer.display.painter import Pixels
from minirt.viewer.editing.motion import WORLD_AXES
from minirt.viewer.editing.projection import Pixel, Projection, dot, extent, projection_of, subtract
from minirt.viewer.editing.state import Frame, State, can_edit, position_of

GOLD, BLACK, WHITE = 0xFFD75F, 0x000000, 0xFFFFFF
AXIS_COLOURS = {Frame.X: 0xFF5050, Frame.Y: 0x60E060, Frame.Z: 0x6090FF}
MOVING_RAYS, STILL_RAYS = 20_000, 60_000  # rays for an outline, while something moves and when nothing does
SIZE = 20  # pixels of a side, times the screen's scale
MAX_ICONS = 200  # so that a scene of many lights is still drawn at once
KINDS_WITH_ICON = tuple(kind for kind in ELEMENTS.values() if can_edit(kind) and not issubclass(kind, Shape))
LENGTH, BORDER, TOP = 18, 8, 36  # pixels: of the arrow, and of room for it at the edge and at the top; times the scale
FILL, RIM = (0x5F, 0xD7, 0xFF, 255), (0, 0, 0, 255)  # BGRA: golden, with a black rim


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

    def toggle_icons(self) -> None:
        """Show or hide the icons of all lights."""
        self.icons = not self.icons

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


class Icon(NamedTuple):
    """A square that stands for an element."""

    owner: int  # the index of its element
    x: int  # centre, in pixels
    y: int
    code: str
    colour: int  # 0xRRGGBB


def elements_with_icon(scene: Scene) -> list[int]:
    """Return the indices of the elements that have an icon."""
    return sorted({index for kind in KINDS_WITH_ICON for index in scene.indices_of(kind)})


def place_icons(scene: Scene, indices: Iterable[int], view: Projection, scale: float) -> list[Icon]:
    """Return the icons of the elements with these indices, as far as they lie within the picture."""
    size = round(SIZE * scale)
    corner = view.width - size
    placed: list[Icon] = []
    for index in indices:
        element = scene.elements[index]
        point = None if isinstance(element, Camera) else position_of(element)
        at: Pixel | None = view.pixel(point) if point else (corner, size)
        corner -= 0 if point else round(1.5 * size)
        if at and 0 <= at[0] < view.width and 0 <= at[1] < view.height and len(placed) < MAX_ICONS:
            placed.append(Icon(index, round(at[0]), round(at[1]), element.code, colour_of(element)))
    return placed


def icon_at(icons: list[Icon], x: int, y: int, scale: float) -> Icon | None:
    """Return the icon under the pointer; if several overlap, the last, which is drawn on top."""
    reach = SIZE * scale / 2
    return next((each for each in reversed(icons) if max(abs(each.x - x), abs(each.y - y)) <= reach), None)


def colour_of(element: Element) -> int:
    """Return the element's own colour as 0xRRGGBB, white if it has none."""
    colours = [getattr(element, field.name) for field in fields_of(type(element)) if isinstance(field, Colour)]
    red, green, blue = map(int, next((each for each in colours if not isinstance(each, str)), (255, 255, 255)))
    return red << 16 | green << 8 | blue


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
