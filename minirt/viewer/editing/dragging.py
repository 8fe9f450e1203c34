"""Drags of the pointer: move or turn an element, orbit, pan or turn the camera.

All functions are pure and start from the state at the press of the button, so that the result depends on the current
position of the pointer alone, and nothing drifts. A drag is undone as a whole.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from minirt.element import Element
from minirt.fields import Triple
from minirt.rendering.queries.pick import pick, surface_point
from minirt.scene import Camera
from minirt.scene.elements import linear_combination
from minirt.shapes import Shape
from minirt.viewer.editing.adding import dropped, stand
from minirt.viewer.editing.motion import (
    WORLD_AXES,
    can_turn,
    clamp_point,
    handedness,
    orbit_camera,
    rotate,
    translate,
    turn_axis,
    turn_camera,
)
from minirt.viewer.editing.projection import UP, Projection, aim, extent, projection_of, scene_centre, subtract
from minirt.viewer.editing.state import State

PIXEL_CENTRE = 0.5  # pixels
CHANGE = ("drag", 0.0)  # kind and time of its changes: the constant time merges them for undo
TURN_ANGLE = 180.0  # degrees: a drag over the shorter side of the picture


class DragStart(NamedTuple):
    """The scene at the press of the button, as far as a drag needs it."""

    projection: Projection
    x: int  # of the pointer, in pixels
    y: int
    element: Element  # the selected one, as it was
    camera: Camera  # as it was
    point: Triple | None  # on the surface under the pointer; None if there is none

    @property
    def moves_camera(self) -> bool:
        """Whether there is no element to move or turn, so that the camera turns instead."""
        return self.point is None or isinstance(self.element, Camera)


def start_drag(state: State, width: int, height: int, x: int, y: int, point: Triple | None) -> DragStart:
    """Start a drag at pixel x, y of a picture of this size."""
    return DragStart(projection_of(state.scene.camera, width, height), x, y, state.element, state.scene.camera, point)


def apply_drag(state: State, action: str, start: DragStart, x: int, y: int) -> State:
    """The state with the pointer at x, y. KeyError if `action` is not in DRAGS."""
    return DRAGS[action](state.with_message(""), start, x, y)


def move(state: State, start: DragStart, x: int, y: int) -> State:
    """Move the element parallel to the image plane, or along an axis, with its point under the pointer."""
    if start.point is None or start.moves_camera:
        return look(state, start, x, y)
    axis = WORLD_AXES.get(state.frame)
    if axis:
        distance = start.projection.distance_along(x + PIXEL_CENTRE, y + PIXEL_CENTRE, start.point, axis)
        if distance is None:
            return state.with_message("the view is along the axis: nothing moves")
        offset = linear_combination(distance, axis, 0.0, axis)
    else:
        offset = subtract(
            point_under_pointer(start, x, y, start.point), point_under_pointer(start, start.x, start.y, start.point)
        )
    moved, clamped = translate(start.element, offset, 1.0)
    state = state.edit_element(moved, *CHANGE)
    return state.with_message("the end of the range: no further") if clamped else state


def place(state: State, start: DragStart, x: int, y: int) -> State:
    """Move a shape to the surface behind the pointer, with its middle on the grid, and drop it there."""
    shape = start.element
    if start.point is None or not isinstance(shape, Shape) or shape.bounds() is None:
        return move(state, start, x, y)
    others, view = state.scene.edit(state.selected), start.projection
    behind = pick(others, view.width, view.height, x, y)
    point = surface_point(behind, start.camera, view.width, view.height, x, y) if behind else None
    there = aim(view, state.size, x + PIXEL_CENTRE, y + PIXEL_CENTRE, behind, point)
    middle = extent(shape)
    assert middle
    at, _ = translate(shape, subtract(there.point, middle[0]), 1.0)
    standing = stand(at, there.point, UP)
    return state.edit_element(dropped(standing, others, state.stride) or standing, *CHANGE)


def point_under_pointer(start: DragStart, x: int, y: int, point: Triple) -> Triple:
    """The point under the pointer at the depth of `point`."""
    return start.projection.point_at_depth(x + PIXEL_CENTRE, y + PIXEL_CENTRE, start.projection.depth(point))


def turn(state: State, start: DragStart, x: int, y: int) -> State:
    """Turn the element about the picture's vertical and horizontal axes, or about an axis of the scene."""
    if isinstance(start.element, Camera):
        return look(state, start, x, y)
    if not can_turn(start.element):
        return state.with_message(f"{start.element.title} looks the same from all sides: nothing to turn")
    right, down = drag_angles(start, x, y)
    axis = WORLD_AXES.get(state.frame)
    if axis:
        return state.edit_element(rotate(start.element, axis, right), *CHANGE)
    across, up = turn_axis(start.camera, 0), turn_axis(start.camera, 1)
    hand = handedness(start.camera)
    return state.edit_element(rotate(rotate(start.element, up, right * hand), across, down * hand), *CHANGE)


def look(state: State, start: DragStart, x: int, y: int) -> State:
    """Turn the camera so that distant objects follow the pointer."""
    step = start.camera.fov / start.projection.width
    camera = turn_camera(start.camera, (start.x - x) * step, (y - start.y) * step)
    return state.edit_camera(camera, *CHANGE)


def orbit(state: State, start: DragStart, x: int, y: int) -> State:
    """Orbit the camera around the selected element, or around the centre of the scene.

    The pivot stays where it is in the picture, and everything in front of it follows the pointer.
    """
    selected = None if isinstance(start.element, Camera) else extent(start.element)
    pivot = selected[0] if selected else scene_centre(state.scene)
    right, down = drag_angles(start, x, y)
    return state.edit_camera(orbit_camera(start.camera, pivot, right, -down), *CHANGE)


def pan(state: State, start: DragStart, x: int, y: int) -> State:
    """Move the camera parallel to its image plane, so that the point under the pointer stays there."""
    ahead = linear_combination(1.0, start.camera.position, state.size, start.camera.direction)
    point = start.point or ahead
    offset = subtract(point_under_pointer(start, start.x, start.y, point), point_under_pointer(start, x, y, point))
    return state.edit_camera(
        start.camera.replace(position=clamp_point(linear_combination(1.0, start.camera.position, 1.0, offset))), *CHANGE
    )


def drag_angles(start: DragStart, x: int, y: int) -> tuple[float, float]:
    """Movement of the pointer to the right and down, as angles in degrees."""
    step = TURN_ANGLE / min(start.projection.width, start.projection.height)
    return (x - start.x) * step, (y - start.y) * step


DRAGS: dict[str, Callable[[State, DragStart, int, int], State]] = {
    "move by hand": move,
    "turn by hand": turn,
    "place by hand": place,
    "orbit": orbit,
    "pan": pan,
}
