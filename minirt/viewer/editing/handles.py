"""Handles of the selected element: arrows along the axes move it, a square in two; rings turn it, boxes resize it."""

from __future__ import annotations

from math import cos, hypot, pi, sin
from typing import NamedTuple

from minirt.element import Element
from minirt.fields import Length, Lengths, Triple
from minirt.scene.elements import Camera, linear_combination
from minirt.viewer.editing.motion import WORLD_AXES
from minirt.viewer.editing.projection import Pixel, Projection, extent, projection_of
from minirt.viewer.editing.rigid import can_turn
from minirt.viewer.editing.state import State
from minirt.viewer.editing.values import Value, values

AXES = tuple(WORLD_AXES.values())
MOVE, TURN, SIZE, SLIDE = "move", "turn", "size", "slide"  # kinds of handles
LEAST = 200  # pixels of a window with room for handles
REACH, NEAR = 64.0, 8.0  # pixels, times the scale: of arrows, and from a handle to a pointer that grabs it
BOX, RING, SQUARE = 1.35, 0.75, 0.4  # times REACH: distance of boxes, radius of rings, distance of the square
CORNERS = 48  # of a ring
AROUND = 2.0  # times REACH: from an element to a pointer for which its handles are shown


class Handle(NamedTuple):
    """Handle of the selected element: a drag of it moves, turns or resizes the element."""

    kind: str
    axis: int  # of the scene
    centre: Triple  # of the element
    points: tuple[Pixel, ...]  # its place in the picture, or a ring's
    value: Value | None = None  # of the element, that a box changes


def handles_of(element: Element, view: Projection, scale: float, several: bool = False, kind: str = "") -> list[Handle]:
    """The handles of an element in the picture.

    There are none for a camera, for an element whose centre is not in front of the eye, and in a picture smaller than
    LEAST. `several`: other elements turn with this one, which then has rings even if it looks the same from all sides.
    `kind`: only handles of this kind are returned, with MOVE also SLIDE; "" for all.
    """
    around = None if isinstance(element, Camera) else extent(element)
    if not around or not view.pixel(around[0]) or min(view.width, view.height) < LEAST:
        return []
    centre, _ = around
    reach = REACH * scale * view.depth(centre) * 2 * hypot(*view.right) / view.width  # scene units
    found: list[Handle] = []

    def add(kind: str, axis: int, *offsets: Triple, value: Value | None = None) -> None:  # offsets: times `reach`
        pixels = tuple(filter(None, (view.pixel(linear_combination(1.0, centre, reach, each)) for each in offsets)))
        found.extend([Handle(kind, axis, centre, pixels, value)] if pixels else [])

    angles = [2 * pi * corner / CORNERS for corner in range(CORNERS + 1)]
    for axis, way in enumerate(AXES):
        add(MOVE, axis, way)
        if several or can_turn(element):
            u, v = AXES[axis - 2], AXES[axis - 1]  # the other two axes
            add(TURN, axis, *(linear_combination(RING * cos(angle), u, RING * sin(angle), v) for angle in angles))
    add(SLIDE, 1, (SQUARE, 0.0, SQUARE))
    own = [each for each in values(element) if each.inner is None]
    resized = Lengths if any(isinstance(each.leaf, Lengths) for each in own) else Length  # parts of three, or single
    lengths = (each for each in own if isinstance(each.leaf, resized) and not isinstance(each.current(element), tuple))
    for (axis, (x, y, z)), value in zip(enumerate(AXES), lengths, strict=False):
        add(SIZE, axis, (BOX * x, BOX * y, BOX * z), value=value)
    return [each for each in found if kind in ("", each.kind) or (kind == MOVE and each.kind == SLIDE)]


def shows_handles(state: State, pointer: tuple[int, int], size: tuple[int, int], scale: float) -> bool:
    """Whether the pointer is so near to the selected element that its handles are shown, or on no pixel so far.

    While it is elsewhere they would hide small things.
    """
    view, around = projection_of(state.scene.camera, *size), extent(state.element)
    middle = view.pixel(around[0]) if around else None
    if not around or not middle or pointer == (0, 0):
        return True
    radius = around[1] * view.width / (2 * view.depth(around[0]) * hypot(*view.right))
    return hypot(pointer[0] - middle[0], pointer[1] - middle[1]) < AROUND * REACH * scale + radius


def handle_at(handles: list[Handle], x: float, y: float, scale: float) -> Handle | None:
    """The handle nearest to a pointer that grabs it; None if there is none."""
    near = [(min(hypot(a - x, b - y) for a, b in each.points), each) for each in handles]
    distance, found = min(near, key=lambda pair: pair[0], default=(NEAR * scale, None))
    return found if distance < NEAR * scale else None
