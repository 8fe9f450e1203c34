"""Drags of the pointer: move or turn an element by itself or by a handle; orbit, pan or turn the camera.

All functions are pure and start from the state at the press of the button, so that the result depends on the current
position of the pointer alone, and nothing drifts. A drag is undone as a whole.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from math import atan2, copysign, degrees, hypot, remainder
from typing import NamedTuple

from minirt.element import Element
from minirt.fields import Triple, clamp_length
from minirt.rendering.queries.pick import pick
from minirt.scene.elements import Camera, linear_combination, multiple
from minirt.shapes import Shape
from minirt.viewer.editing import motion
from minirt.viewer.editing.handles import AXES, SLIDE, TURN, Handle
from minirt.viewer.editing.motion import RIGHT, UPWARD, WORLD_AXES
from minirt.viewer.editing.placing import aim, dropped, keep_standing, lowest_along, middle_of, settled
from minirt.viewer.editing.projection import UP, Pixel, Projection, dot, position_of, scene_centre, subtract
from minirt.viewer.editing.rigid import shifted
from minirt.viewer.editing.state import State
from minirt.viewer.editing.values import leading_decimal
from minirt.viewer.language import GAP

PIXEL_CENTRE = 0.5  # pixels
# Kind and time of the changes of a drag, the last arguments of all edits: undo takes together what has the same time.
MERGED = "drag", 0.0
SNAP_ANGLE = 15.0  # degrees
LEVEL = 1e-6  # in place of the slope of a level ray
FINE = 0.1  # of a pixel or a degree, with Shift
TURN_ANGLE = 180.0  # degrees: a drag over the shorter side of the picture


class DragStart(NamedTuple):
    """A mouse button that is down on the picture, and the scene at its press, as far as a drag needs it."""

    projection: Projection
    x: int  # of the pointer, in pixels
    y: int
    element: Element  # the selected one, as it was
    camera: Camera  # as it was
    point: Triple | None  # on the surface under the pointer, or that the camera orbits; None if there is none
    button: int = 0
    action: str = ""  # of DRAGS
    dragging: bool = False  # whether the pointer has moved far enough since
    handle: Handle | None = None  # of the element, that the pointer has grabbed
    reach: Pixel = (0.0, 0.0)  # how far a handle was pulled, to the right and down; a tenth while Shift is down
    snaps: bool = False  # whether Ctrl is down, so that a handle snaps to a grid
    fine: bool = False  # whether Shift is down
    owner: int | None = None  # index of the element under the pointer

    @property
    def moves_camera(self) -> bool:
        """Whether there is no element to move or turn, so that the camera turns instead."""
        return self.point is None or self.element is self.camera


def move(state: State, start: DragStart, x: int, y: int) -> State:
    """Move the element parallel to the image plane, or along the axis of the frame, as far as the pointer went to x, y.
    If no element was under the pointer at the press, or the element is the camera, turn the camera instead."""
    if start.point is None or start.moves_camera:
        return look(state, start, x, y)
    axis = WORLD_AXES.get(state.frame)
    if axis:
        distance = start.projection.distance_along(x + PIXEL_CENTRE, y + PIXEL_CENTRE, start.point, axis)
        if distance is None:
            return state.with_message("the view is along the axis: nothing moves")
        way = multiple(distance, axis)
    else:
        way = pointer_offset(start, x, y, start.point)
    way = snapped_way(start.element, start.point, way, resolution(start, start.point))
    return motion.move(state, start.element, way, 1.0, *MERGED)


def place(state: State, start: DragStart, x: int, y: int, turns: bool = False) -> State:
    """Move a bounded shape to the surface behind the pointer at x, y, with its middle on the grid, and drop it there.

    `turns`: the shape stands there as a new one would, also on walls, with its axis along the normal. Other elements
    are moved as by `move`, and so is a shape that turns where there is no surface.
    """
    shape, view = start.element, start.projection
    if start.point is None or not isinstance(shape, Shape) or shape.bounds() is None:
        return move(state, start, x, y)
    others = state.rest
    behind = pick(others, view.width, view.height, x, y)
    there = aim(view, state.size, x + PIXEL_CENTRE, y + PIXEL_CENTRE, *behind)
    if turns and there.normal is None:
        return move(state, start, x, y)
    if turns:
        return replace(motion.put(state, shape, settled(shape, there, others, state.stride), *MERGED), aim=there)
    at = shifted(shape, subtract(there.point, middle_of(shape)[0]))
    standing = shifted(at, UP, there.point[1] - lowest_along(at, UP))
    return motion.put(state, shape, dropped(standing, others, state.stride) or standing, *MERGED)


def pointer_offset(start: DragStart, x: int, y: int, point: Triple) -> Triple:
    """The way of the pointer to x, y, at the depth of `point`."""
    view, depth = start.projection, start.projection.depth(point)
    here = view.direction_through(start.x + PIXEL_CENTRE, start.y + PIXEL_CENTRE)
    return linear_combination(depth, view.direction_through(x + PIXEL_CENTRE, y + PIXEL_CENTRE), -depth, here)


def pull(state: State, start: DragStart, _x: int, _y: int) -> State:
    """Move, turn or resize the element by its handle; with Ctrl on a grid, or by steps of SNAP_ANGLE.

    How far the handle is pulled is in `start`, not in the position of the pointer, so that Shift can make it slower.
    """
    handle, view, element = start.handle, start.projection, start.element
    assert handle
    x, y = start.x + PIXEL_CENTRE, start.y + PIXEL_CENTRE
    right, down = start.reach
    ends = (x, y), (x + right, y + down)  # of the pull, in pixels
    if handle.kind == TURN:
        return turn_ring(state, start, handle, ends)
    centre, axis = handle.centre, AXES[handle.axis]
    step = state.stride if start.snaps else resolution(start, centre)
    if handle.kind == SLIDE:
        way = way_on_level(view, centre, ends)
    else:
        before, after = (view.distance_along(*end, centre, axis) for end in ends)
        is_over_centre = handle.value and before == 0.0  # where no length can be told from it
        if before is None or after is None or is_over_centre:
            return state.with_message("the view is along the axis: nothing moves")
        if handle.value:
            length = handle.value.current(element) * abs(after / before)
            length = clamp_length(max(snapped(length, step), step))
            changed = element.replace(**{handle.value.field.name: handle.value.replaced(element, length)})
            return state.edit_element(keep_standing(state, element, changed), *MERGED)
        way = multiple(after - before, axis)
    return motion.move(state, element, snapped_way(element, centre, way, step), 1.0, *MERGED)


def turn_ring(state: State, start: DragStart, handle: Handle, ends: tuple[Pixel, Pixel]) -> State:
    """Turn the element about the axis of a ring, by the angle of a pull as seen from the ring's centre in the picture.

    `ends`: of the pull, in pixels. A ring about a point that is not in front of the eye has no handle to be pulled.
    """
    view, axis = start.projection, AXES[handle.axis]
    middle_x, middle_y = view.pixel(handle.centre) or (0.0, 0.0)
    first, last = (degrees(atan2(y - middle_y, x - middle_x)) for x, y in ends)
    towards_eye = copysign(1.0, dot(axis, subtract(view.eye, handle.centre)))  # 1 if the axis points there, else -1
    counterclockwise = remainder(first - last, 360.0) * motion.handedness(start.camera)  # as y goes down in pictures
    smallest = FINE if start.fine else 1.0
    angle = snapped(counterclockwise * towards_eye, SNAP_ANGLE if start.snaps else smallest)
    turned = motion.rotate_all(state, start.element, [(axis, angle)], *MERGED)
    said = f"turned by {angle:.3g} degrees", f"Ctrl: by steps of {SNAP_ANGLE:g}"
    return turned.with_message(GAP.join(said))


def way_on_level(view: Projection, centre: Triple, ends: tuple[Pixel, Pixel]) -> Triple:
    """Return the way on the level plane through `centre` from where the ray through one pixel meets it to the other's.

    There is none, (0, 0, 0), where one of them meets the plane behind the eye.
    """
    rays = [view.ray(*end) for end in ends]
    distances = [(centre[1] - view.eye[1]) / (ray[1] or LEVEL) for ray in rays]
    if min(distances) <= 0:
        return 0.0, 0.0, 0.0
    before, after = (multiple(distance, ray) for distance, ray in zip(distances, rays, strict=True))
    return subtract(after, before)


def resolution(start: DragStart, point: Triple) -> float:
    """The power of ten that is not above the size of a pixel at the depth of a point, with Shift of a tenth of one.

    Positions and lengths that a drag gives are multiples of it: finer ones are not seen, and long to read.
    """
    view = start.projection
    pixel = view.depth(point) * 2 * hypot(*view.right) / view.width * (FINE if start.fine else 1.0)
    return float(10.0 ** -leading_decimal(pixel)) if pixel > 0 else 0.0


def snapped_way(element: Element, point: Triple, way: Triple, step: float) -> Triple:
    """The way that takes the position of an element, or else a point, to the multiples of a step nearest to its end."""
    parts = zip(position_of(element) or point, way, strict=True)
    x, y, z = (snapped(part + length, step) - part if length else 0.0 for part, length in parts)
    return x, y, z


def snapped(number: float, step: float) -> float:
    """The multiple of a step that is nearest to a number; the number itself without a step."""
    return step * round(number / step) if step else number


def turn(state: State, start: DragStart, x: int, y: int) -> State:
    """Turn the element about the picture's vertical and horizontal axes, or about an axis of the scene."""
    if start.element is start.camera:
        return look(state, start, x, y)
    right, down = drag_angles(start, x, y)
    turns = [(UPWARD, right), (RIGHT, -down)]
    return motion.turn(state, start.element, turns[: 1 if state.frame in WORLD_AXES else 2], *MERGED)


def look(state: State, start: DragStart, x: int, y: int) -> State:
    """Turn the camera so that distant objects follow the pointer."""
    step = start.camera.fov / start.projection.width
    camera = motion.turn_camera(start.camera, (start.x - x) * step, (y - start.y) * step)
    return state.edit_camera(camera, *MERGED)


def orbit(state: State, start: DragStart, x: int, y: int) -> State:
    """Orbit the camera around the point where the drag began, or around the centre of the scene.

    The pivot stays where it is in the picture, and everything in front of it follows the pointer.
    """
    pivot = start.point or scene_centre(state.scene)
    right, down = drag_angles(start, x, y)
    return state.edit_camera(motion.orbit_camera(start.camera, pivot, right, -down), *MERGED)


def pan(state: State, start: DragStart, x: int, y: int) -> State:
    """Move the camera parallel to its image plane, so that the point under the pointer stays there."""
    ahead = linear_combination(1.0, start.camera.position, state.size, start.camera.direction)
    x_way, y_way, z_way = pointer_offset(start, x, y, start.point or ahead)
    return state.edit_camera(shifted(start.camera, (-x_way, -y_way, -z_way)), *MERGED)


def drag_angles(start: DragStart, x: int, y: int) -> tuple[float, float]:
    """Movement of the pointer to the right and down, as angles in degrees."""
    step = TURN_ANGLE / min(start.projection.width, start.projection.height)
    return (x - start.x) * step, (y - start.y) * step


DRAGS: dict[str, Callable[[State, DragStart, int, int], State]] = {
    "move by hand": move,
    "turn by hand": turn,
    "place by hand": place,
    "slide by hand": partial(place, turns=True),
    "orbit": orbit,
    "pan": pan,
}
