"""Editing actions of the keys: pure functions State -> State, named as in the table of bindings.

`amount` is a number of steps: 1 for a press, fractions while a key is held or with Shift. `now` is the time in seconds,
by which changes are merged for undo. Actions depend on the types of fields that elements have, never on a shape.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from minirt.errors import ElementError
from minirt.fields import MeshFile, Point
from minirt.scene import Camera
from minirt.scene.camera_frame import camera_frame
from minirt.viewer.editing import attributes, framing, history, selection, standing, structure
from minirt.viewer.editing.motion import WORLD_AXES, handedness, roll_camera, rotate, translate, turn_camera
from minirt.viewer.editing.orientation import can_turn, turn_axis
from minirt.viewer.editing.state import Frame, State, field_names
from minirt.viewer.editing.values import values
from minirt.viewer.files import asset_files

Edit = Callable[[State, float, float], State]  # (state, amount, now)

TURN_STEP = 5.0  # degrees

RIGHT, UP, FORWARD = range(3)  # axes of `camera_frame`


def apply(state: State, action: str, amount: float = 1.0, now: float = 0.0) -> State:
    """The state after an action. KeyError if `action` is not in EDITS."""
    try:
        return EDITS[action](state.with_message(""), amount, now)
    except ElementError as error:
        return state.with_message(str(error))


def move(axis: int, sign: float, state: State, amount: float, now: float) -> State:
    """Move the selected element: the camera along its own axes, any other element along those of the frame."""
    element = state.element
    if not field_names(type(element), Point):
        return state.with_message(f"{element.title} has no position to move")
    frame = Frame.VIEW if isinstance(element, Camera) else state.frame
    direction = WORLD_AXES.get(frame) or camera_frame(state.scene.camera)[axis]
    moved, clamped = translate(element, direction, sign * amount * state.stride)
    state = state.edit_element(moved, "move", now)
    return state.with_message("the end of the range: no further") if clamped else state


def turn(axis: int, sign: float, state: State, amount: float, now: float) -> State:
    """Turn the selected element: to the right about UP, upwards about RIGHT, clockwise about FORWARD."""
    element, angle = state.element, sign * amount * TURN_STEP
    if isinstance(element, Camera):
        if axis == FORWARD:
            return state.edit_element(roll_camera(element, angle), "roll", now)
        return state.edit_element(turn_camera(element, angle * (axis == UP), angle * (axis == RIGHT)), "turn", now)
    if not can_turn(element):
        return state.with_message(f"{element.title} looks the same from all sides: nothing to turn")
    about = WORLD_AXES.get(state.frame)
    if not about:
        # Seen from the camera the front goes right, up or clockwise: only up is opposite to the right-handed rotation.
        about, angle = turn_axis(state.scene.camera, axis), angle * handedness(state.scene.camera)
        angle = -angle if axis == RIGHT else angle
    turned = state.edit_element(rotate(element, about, angle), "turn", now)
    if turned is state:
        return state.with_message(f"{element.title} looks the same after a turn about its own axis")
    return turned


def change_value(sign: float, state: State, amount: float, now: float) -> State:
    """Change the active value of the selected element."""
    active = state.active
    if active is None:
        return state.with_message(f"{state.element.title} has no size")
    next_file = partial(asset_files.next_file, state.scene)
    new = state.element.replace(**{active.field.name: active.stepped(state.element, sign * amount, next_file)})
    changed = state.edit_element(standing.keep_standing(state, new), f"value {active.name}", now)
    if changed is state:
        value = active.get(state.element)
        if isinstance(value, str | MeshFile):
            noun = "picture" if isinstance(value, str) else "mesh"
            return state.with_message(f"there is no other {noun} beside the scene")
        limits = f" ({active.range})" if active.range else ""
        return state.with_message(f"{active.name} cannot go further{limits}")
    return changed


def turn_wheel(sign: float, state: State, amount: float, now: float) -> State:
    """Move the camera nearer to what it shows, or change the active value of any other element."""
    if isinstance(state.element, Camera):
        return framing.approach(state, sign * amount, now)
    return change_value(sign, state, amount, now)


def next_value(state: State, _amount: float, _now: float) -> State:
    """Make the next value of the selected element active."""
    count = len(values(state.element))
    if not count:
        return state.with_message(f"{state.element.title} has no value to change")
    return replace(state, value_index=(state.value_index + 1) % count, last_change=None)


def next_frame(state: State, _amount: float, _now: float) -> State:
    """Switch to the next frame of movement: the view, X, Y, Z."""
    frames = list(Frame)
    return replace(state, frame=frames[(frames.index(state.frame) + 1) % len(frames)], last_change=None)


EDITS: dict[str, Edit] = {
    "select next": partial(selection.select_neighbour, 1),
    "select previous": partial(selection.select_neighbour, -1),
    "select camera": selection.select_camera,
    "select light": selection.select_next_light,
    "left": partial(move, RIGHT, -1.0),
    "right": partial(move, RIGHT, 1.0),
    "forward": partial(move, FORWARD, 1.0),
    "back": partial(move, FORWARD, -1.0),
    "down": partial(move, UP, -1.0),
    "up": partial(move, UP, 1.0),
    "turn left": partial(turn, UP, -1.0),
    "turn right": partial(turn, UP, 1.0),
    "turn up": partial(turn, RIGHT, 1.0),
    "turn down": partial(turn, RIGHT, -1.0),
    "roll left": partial(turn, FORWARD, -1.0),
    "roll right": partial(turn, FORWARD, 1.0),
    "next frame": next_frame,
    "grow": partial(change_value, 1.0),
    "shrink": partial(change_value, -1.0),
    "nearer": partial(turn_wheel, 1.0),
    "farther": partial(turn_wheel, -1.0),
    "drop": standing.drop,
    "next value": next_value,
    "add attribute": attributes.add_attribute,
    "remove attribute": attributes.remove_attribute,
    "next tone": framing.next_tone,
    "look at": framing.look_at,
    "reset camera": framing.reset_camera,
    "undo": history.undo,
    "redo": history.redo,
    "add": partial(structure.add, 1),
    "add previous": partial(structure.add, -1),
    "duplicate": structure.duplicate,
    "delete": structure.delete,
}
