"""Marks over the picture: outlines of selected shapes, axis of its movement, icons, an arrow to what is outside."""

from __future__ import annotations

from collections.abc import Iterable
from math import hypot
from typing import NamedTuple

import numpy as np

from minirt.element import Element
from minirt.fields import Triple
from minirt.mlx.text import draw_text, measure
from minirt.scene import Lamp, Scene
from minirt.scene.elements import linear_combination
from minirt.scene.names import element_name
from minirt.scene.registry import ELEMENTS
from minirt.shapes import Shape
from minirt.viewer.display.jobs import Pixels
from minirt.viewer.display.lists import draw_on_dark
from minirt.viewer.display.outline import PixelIndices, outline_pixels
from minirt.viewer.editing.colours import own_colour
from minirt.viewer.editing.handles import MOVE, SLIDE, TURN, Handle, handles_of
from minirt.viewer.editing.handles import SIZE as RESIZE
from minirt.viewer.editing.motion import WORLD_AXES
from minirt.viewer.editing.projection import Pixel, Projection, dot, extent, position_of, projection_of, subtract
from minirt.viewer.editing.state import MoveAxes, State, can_edit
from minirt.viewer.language import translated

PLAIN = 255, 255, 255  # the square of an element without a colour
GOLD, BLACK, WHITE = 0xFFFFD75F, 0xFF000000, 0xFFFFFFFF
ORANGE = 0xFFE8862E  # of selected elements beside the primary one, which is golden
AXIS_COLOURS = {MoveAxes.X: 0xFFFF5050, MoveAxes.Y: 0xFF60E060, MoveAxes.Z: 0xFF6090FF}
AXIS_LENGTH = 0.6  # of the distance to the eye: what is drawn of an axis on both sides of an element
MOVING_RAYS, STILL_RAYS = 20_000, 60_000  # rays for an outline, while something moves and when nothing does
SIZE = 20  # pixels of a side, times the screen's scale
HANDLE_SCALES = {MOVE: 0.6, RESIZE: 0.7, SLIDE: 0.4}  # of the size of icons
STEPS = 12  # points that are drawn between two corners of a ring, times the scale
MAX_ICONS = 200  # so that a scene of many lights is still drawn at once
KINDS_WITH_ICON = tuple(kind for kind in ELEMENTS.values() if can_edit(kind) and not issubclass(kind, Shape))
LENGTH, BORDER, TOP = 18, 8, 36  # pixels: of the arrow, and of room for it at the edge and at the top; times the scale


def draw_marks(
    pixels: Pixels,
    state: State,
    scene: Scene,
    scale: float,
    *,
    moving: bool,
    icons: bool,
    handles: bool = False,
    kind: str = "",
    pointed: int | None = None,
) -> None:
    """Draw all marks over a picture of `scene`, which may be another version of the state's scene.

    The marks fit the picture: an element that it does not show yet has none. `icons`: show those of all lights;
    `handles`: show those of the primary element, or of a `kind` alone; `pointed`: the index of an element that the
    pointer is on in a list.
    """
    height, width = pixels.shape[:2]
    view = projection_of(scene.camera, width, height)
    others = state.indices_in(scene, state.others)
    colours = dict.fromkeys(others, ORANGE)  # of the marks, by the index of the element in `scene`
    if pointed is not None and pointed < len(state.scene.elements):
        colours |= dict.fromkeys(state.indices_in(scene, frozenset([pointed])), WHITE)
    selected = state.indices_in(scene, frozenset([state.selected]))  # one index, or none
    colours |= dict.fromkeys(selected, GOLD)
    rays = MOVING_RAYS if moving else STILL_RAYS
    for index, colour in colours.items():
        element = scene.elements[index]
        if isinstance(element, Shape):
            draw_outline(pixels, *outline_pixels(element, scene.camera, width, height, rays), colour)
    for index in selected:
        element = scene.elements[index]
        draw_axis(pixels, view, element, state.frame)
        for handle in handles_of(element, view, scale, bool(others), kind) if handles else []:
            draw_handle(pixels, handle, view.pixel(handle.centre), scale)
    for owner, direction in arrows(scene, colours, view, icons).items():
        draw_arrow(pixels, direction, scale, element_name(scene, owner, translated) if owner in colours else "")
    for icon in visible_icons(scene, colours, view, scale, icons):
        draw_icon(pixels, icon, scale, colours.get(icon.owner, BLACK))


def draw_axis(pixels: Pixels, view: Projection, element: Element, frame: MoveAxes) -> None:
    """Draw the axis of the world along which an element moves, through its centre; nothing for those of the view."""
    around, axis = extent(element), WORLD_AXES.get(frame)
    if around and axis:
        centre, _ = around
        reach = AXIS_LENGTH * view.depth(centre)
        start, end = (view.pixel(linear_combination(1.0, centre, way, axis)) for way in (-reach, reach))
        if start and end:
            draw_line(pixels, start, end, AXIS_COLOURS[frame])


def draw_outline(pixels: Pixels, outside: PixelIndices, inside: PixelIndices, colour: int) -> None:
    """Draw a line, two pixels wide, with a black line on either side for contrast with any colour."""
    height, width = pixels.shape[:2]
    for rows, columns in (outside, inside):
        for down, right in ((-1, 0), (1, 0), (0, -1), (0, 1)):
            around = np.clip(rows + down, 0, height - 1), np.clip(columns + right, 0, width - 1)
            pixels[around] = bgra(BLACK)
    pixels[inside] = pixels[outside] = bgra(colour)


def draw_line(pixels: Pixels, start: Pixel, end: Pixel, colour: int) -> None:
    """Draw a line, two pixels wide, between two points of the picture."""
    height, width = pixels.shape[:2]
    (x, y), (dx, dy) = start, (end[0] - start[0], end[1] - start[1])
    at = np.linspace(0.0, 1.0, int(hypot(dx, dy)) + 2)
    columns = np.round(x + at * dx).astype(np.int64).clip(0, width - 1)
    rows = np.round(y + at * dy).astype(np.int64).clip(0, height - 1)
    pixels[rows, columns] = bgra(colour)
    steep = abs(dy) > abs(dx)
    pixels[np.minimum(rows + (not steep), height - 1), np.minimum(columns + steep, width - 1)] = bgra(colour)


def draw_handle(pixels: Pixels, handle: Handle, centre: Pixel | None, scale: float) -> None:
    """Draw a handle in the colour of its axis.

    `centre`: of the element, None where it is not in front of the eye. Arrows that move have the letter of the axis,
    boxes that resize the first letter of the value that they change.
    """
    colour, (x, y) = list(AXIS_COLOURS.values())[handle.axis], handle.points[0]
    if handle.kind == TURN:
        numbers, ring = np.arange(len(handle.points)), np.array(handle.points)  # all at once: a tenth of the time
        places = np.linspace(0, len(numbers) - 1, round(STEPS * scale) * len(numbers))  # also between two points
        right, down = (np.interp(places, numbers, ring[:, part]).astype(np.int64) for part in (0, 1))
        for rows, columns in ((down, right), (down + 1, right), (down, right + 1)):  # two pixels wide
            pixels[rows.clip(0, pixels.shape[0] - 1), columns.clip(0, pixels.shape[1] - 1)] = bgra(colour)
        return
    if handle.kind == MOVE and centre:
        draw_line(pixels, centre, (x, y), colour)
    letter = translated(handle.value.name)[0] if handle.value else "XYZ"[handle.axis]
    icon = Icon(0, round(x), round(y), "" if handle.kind == SLIDE else letter, colour)
    draw_icon(pixels, icon, HANDLE_SCALES[handle.kind] * scale, GOLD if handle.kind == RESIZE else BLACK)


def draw_icon(pixels: Pixels, icon: Icon, scale: float, frame_colour: int) -> None:
    """Draw a square in the element's colour with its identifier, and a frame."""
    half, frame = round(SIZE * scale / 2), max(1, round(2 * scale))
    for reach, colour in ((half + frame, frame_colour), (half, icon.colour)):
        top, bottom, left, right = (max(0, at + way) for at in (icon.y, icon.x) for way in (-reach, reach))
        pixels[top:bottom, left:right] = bgra(colour)
    bright = sum(icon.colour >> shift & 0xFF for shift in (0, 8, 16)) > 3 * 110
    size = round(14 * scale)
    width, height = measure(icon.code, size)
    draw_text(pixels, icon.x - width // 2, icon.y - height // 2, icon.code, BLACK if bright else WHITE, size=size)


def bgra(colour: int) -> tuple[int, ...]:
    """Split 0xAARRGGBB into the four bytes of a pixel."""
    return tuple(colour.to_bytes(4, "little"))


class Icon(NamedTuple):
    """A square that stands for an element."""

    owner: int  # the index of its element
    x: int  # centre, in pixels
    y: int
    code: str
    colour: int  # 0xFFRRGGBB


def visible_icons(scene: Scene, marked: Iterable[int], view: Projection, scale: float, every: bool) -> list[Icon]:
    """Return the icons within the picture, at most MAX_ICONS: with `every` those of all elements that can have one,
    otherwise those of the elements whose indices are `marked`, except shapes and the camera in view.

    Icons of elements without a position, and of the camera in view, stand in a row at the upper right corner.
    """
    if every:
        owners = sorted({index for kind in KINDS_WITH_ICON for index in scene.indices_of(kind)})
    else:
        elements = {index: scene.elements[index] for index in sorted(marked)}
        owners = [at for at, each in elements.items() if not isinstance(each, Shape) and each is not scene.camera]
    size = round(SIZE * scale)
    next_x = view.width - size  # of the icon that has no position
    placed: list[Icon] = []
    for index in owners:
        owner = scene.elements[index]
        place = None if owner is scene.camera else position_of(owner)
        at: Pixel | None = view.pixel(place) if place else (next_x, size)
        next_x -= 0 if place else round(1.5 * size)
        if at and 0 <= at[0] < view.width and 0 <= at[1] < view.height and len(placed) < MAX_ICONS:
            red, green, blue = map(int, own_colour(owner) or PLAIN)
            colour = 0xFF << 24 | red << 16 | green << 8 | blue
            placed.append(Icon(index, round(at[0]), round(at[1]), owner.code, colour))
    return placed


def arrow_direction(view: Projection, point: Triple, radius: float = 0.0) -> tuple[float, float] | None:
    """Return the direction from the middle of the picture towards a ball outside: right and down, of length 1.

    None if a part of the ball, whose centre is `point`, may be in the picture, or if the eye is in the ball.
    """
    depth = view.depth(point)
    offset = subtract(point, view.eye)
    across, up = dot(offset, view.right) / hypot(*view.right), dot(offset, view.up) / hypot(*view.up)
    at = view.pixel(point)
    if at and depth > 0:
        reach = view.width / 2 / hypot(*view.right) * radius / depth  # in pixels: `right` is half the width, 1 deep
        if -reach <= at[0] < view.width + reach and -reach <= at[1] < view.height + reach:
            return None
    elif hypot(*offset) <= radius:
        return None
    length = hypot(across, up)
    return (across / length, -up / length) if length else (0.0, 1.0)  # down to what is straight behind the eye


def arrows(scene: Scene, marked: Iterable[int], view: Projection, every: bool) -> dict[int, tuple[float, float]]:
    """Directions towards elements outside of the picture, by index: the marked ones, and with `every` all lights."""
    owners = {*marked, *(scene.indices_of(Lamp) if every else ())}
    found = {owner: extent(scene.elements[owner]) for owner in owners}
    ways = {owner: arrow_direction(view, *around) for owner, around in found.items() if around}
    return {owner: way for owner, way in ways.items() if way and not getattr(scene.elements[owner], "infinite", False)}


def arrow_tip(direction: tuple[float, float], width: int, height: int, scale: float) -> Pixel:
    """Tip of the arrow at the border of the picture, on a line from its middle in this direction."""
    border, top = min(BORDER * scale, width / 4, height / 8), min(TOP * scale, height / 4)
    room = width / 2 - border, (height - border - top) / 2
    reach = min(side / abs(part) for side, part in zip(room, direction, strict=True) if part)
    return width / 2 + reach * direction[0], top + room[1] + reach * direction[1]


def draw_arrow(pixels: Pixels, direction: tuple[float, float], scale: float, name: str = "") -> None:
    """Draw an arrow with its tip at the border of the picture, and `name` beside it, if there is one.

    direction: right and down, of length 1.
    """
    height, width = pixels.shape[:2]
    tip = arrow_tip(direction, width, height, scale)
    size = LENGTH * scale
    if name:
        (breadth, line), font = measure(name, round(size)), round(size)
        left, middle = (at - 1.5 * size * way for at, way in zip(tip, direction, strict=True))
        left -= breadth * (1 + direction[0]) / 2  # beside the arrow, on the side of the middle of the picture
        place = round(min(max(left, 0), width - breadth)), round(middle - line / 2)
        draw_on_dark(pixels, *place, name, GOLD, size=font)
    left, top = (max(0, int(at - 2 * size)) for at in tip)
    pixels = pixels[top : int(tip[1] + 2 * size), left : int(tip[0] + 2 * size)]  # all of them would take 24 ms
    # Each pixel's distance back from the tip, and from the line through the arrow. Black is two or three pixels wider.
    y, x = np.ogrid[top : top + pixels.shape[0], left : left + pixels.shape[1]]
    along = (tip[0] - x - 0.5) * direction[0] + (tip[1] - y - 0.5) * direction[1]
    beside = np.abs((x + 0.5 - tip[0]) * direction[1] - (y + 0.5 - tip[1]) * direction[0])
    pixels[(along >= -2 * scale) & (along <= size + 2 * scale) & (beside <= along / 2 + 3 * scale)] = bgra(BLACK)
    pixels[(along >= 0) & (along <= size) & (beside <= along / 2)] = bgra(GOLD)
