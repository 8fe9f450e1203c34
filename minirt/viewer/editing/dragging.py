"""What the pointer does to a scene while a button is held: pure functions of the state at its press.

All of them start afresh from that state, so that the way of the pointer does not matter, and nothing drifts. The whole
of a drag is undone at once.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from minirt.element import Element
from minirt.fields import Direction, Triple
from minirt.scene import Camera
from minirt.scene.camera_frame import camera_frame, linear_combination
from minirt.viewer.editing.measure import ball, middle_of
from minirt.viewer.editing.motion import WORLD, handedness, limited, looked, orbited, rotated, translated
from minirt.viewer.editing.projection import Projection, minus, projection
from minirt.viewer.editing.state import State, named

MIDDLE = 0.5  # of a pixel
DRAG = ("drag", 0.0)  # kind and time of its changes: for the undo no time goes by in it
TURN = 180.0  # degrees: a drag over the shorter side of the picture


class Grip(NamedTuple):
    """What the pointer has taken hold of."""

    lens: Projection
    x: int  # of the pointer, in pixels
    y: int
    element: Element  # the selected one, as it was
    camera: Camera  # as it was
    point: Triple | None  # in the scene, under the pointer; None where nothing is there


def grip(state: State, width: int, height: int, x: int, y: int, point: Triple | None) -> Grip:
    """Take hold at a pixel of a picture of that size."""
    return Grip(projection(state.scene.camera, width, height), x, y, state.element, state.scene.camera, point)


def dragged(state: State, action: str, held: Grip, x: int, y: int) -> State:
    """The state with the pointer at x, y; KeyError where there is no such action."""
    return DRAGS[action](state.say(""), held, x, y)


def move(state: State, held: Grip, x: int, y: int) -> State:
    """Move the element in the plane of the view, or along the axis: what is under the pointer stays there."""
    if held.point is None or isinstance(held.element, Camera):
        return look(state, held, x, y)
    axis = WORLD.get(state.frame)
    if axis:
        distance = held.lens.along(x + MIDDLE, y + MIDDLE, held.point, axis)
        if distance is None:
            return state.say("seen along the axis nothing moves")
        way = linear_combination(distance, axis, 0.0, axis)
    else:
        way = minus(under(held, x, y, held.point), under(held, held.x, held.y, held.point))
    moved, met = translated(held.element, way, 1.0)
    state = state.put(moved, *DRAG)
    return state.say("the end of the range: no further") if met else state


def under(held: Grip, x: int, y: int, point: Triple) -> Triple:
    """The place under the pointer that is as far away as `point`."""
    return held.lens.at_depth(x + MIDDLE, y + MIDDLE, held.lens.depth(point))


def turn(state: State, held: Grip, x: int, y: int) -> State:
    """Turn the element about the picture's up and right, or about the axis."""
    if isinstance(held.element, Camera):
        return look(state, held, x, y)
    if not named(type(held.element), Direction):
        return state.say(f"{held.element.title} looks the same from all sides: nothing to turn")
    right, down = angles(held, x, y)
    axis = WORLD.get(state.frame)
    if axis:
        return state.put(rotated(held.element, axis, right), *DRAG)
    across, up, _ = camera_frame(held.camera)
    hand = handedness(held.camera)
    return state.put(rotated(rotated(held.element, up, right * hand), across, down * hand), *DRAG)


def look(state: State, held: Grip, x: int, y: int) -> State:
    """Turn the camera so that far things follow the pointer."""
    step = held.camera.fov / held.lens.width
    camera = looked(held.camera, (held.x - x) * step, (y - held.y) * step)
    return state.put_camera(camera, *DRAG)


def orbit(state: State, held: Grip, x: int, y: int) -> State:
    """Lead the camera round the selected element, or round the middle of the scene: what is there stays in the picture
    where it is, and what is in front of it follows the pointer."""
    around = None if isinstance(held.element, Camera) else ball(held.element)
    pivot = around[0] if around else middle_of(state.scene)
    right, down = angles(held, x, y)
    return state.put_camera(orbited(held.camera, pivot, right, -down), *DRAG)


def pan(state: State, held: Grip, x: int, y: int) -> State:
    """Move the camera in the plane of its picture: what is under the pointer stays there."""
    ahead = linear_combination(1.0, held.camera.position, state.size, held.camera.direction)
    point = held.point or ahead
    way = minus(under(held, held.x, held.y, point), under(held, x, y, point))
    return state.put_camera(
        held.camera.replace(position=limited(linear_combination(1.0, held.camera.position, 1.0, way))), *DRAG
    )


def angles(held: Grip, x: int, y: int) -> tuple[float, float]:
    """How far the pointer went to the right and down, in degrees."""
    step = TURN / min(held.lens.width, held.lens.height)
    return (x - held.x) * step, (y - held.y) * step


DRAGS: dict[str, Callable[[State, Grip, int, int], State]] = {
    "move by hand": move,
    "turn by hand": turn,
    "orbit": orbit,
    "pan": pan,
}
