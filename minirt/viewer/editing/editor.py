"""What the keys do to a scene: pure functions State -> State, by the names in the table of bindings.

`amount` is a number of steps: 1 for a press, parts of one while a key is held or with Shift. `now` is in seconds, for
what is undone together. No shape is known here, only the sorts of fields that elements have.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from minirt.errors import ElementError
from minirt.fields import Direction, MeshFile, Point
from minirt.scene import Camera
from minirt.scene.camera_frame import camera_frame
from minirt.viewer.editing import attributes, framing, history, selection, structure
from minirt.viewer.editing.motion import WORLD, handedness, looked, rolled, rotated, translated
from minirt.viewer.editing.state import Frame, State, named
from minirt.viewer.editing.values import values
from minirt.viewer.files import asset_files

Edit = Callable[[State, float, float], State]  # (state, amount, now)

ANGLE = 5.0  # degrees: one step of a turn

RIGHT, UP, FORWARD = range(3)  # of view()


def apply(state: State, action: str, amount: float = 1.0, now: float = 0.0) -> State:
    """The state after an action; KeyError where there is no such one."""
    try:
        return EDITS[action](state.say(""), amount, now)
    except ElementError as error:
        return state.say(str(error))


def move(way: int, sign: float, state: State, amount: float, now: float) -> State:
    """Move the selected element: the camera along its own axes, everything else in the frame of movement."""
    element = state.element
    if not named(type(element), Point):
        return state.say(f"{element.title} has no place to move from")
    frame = Frame.VIEW if isinstance(element, Camera) else state.frame
    axis = WORLD.get(frame) or camera_frame(state.scene.camera)[way]
    moved, met = translated(element, axis, sign * amount * state.stride)
    state = state.put(moved, "move", now)
    return state.say("the end of the range: no further") if met else state


def turn(axis: int, sign: float, state: State, amount: float, now: float) -> State:
    """Turn the selected element: to the right about up, up about right, clockwise about forward."""
    element, angle = state.element, sign * amount * ANGLE
    if isinstance(element, Camera):
        if axis == FORWARD:
            return state.put(rolled(element, angle), "roll", now)
        return state.put(looked(element, angle * (axis == UP), angle * (axis == RIGHT)), "turn", now)
    if not named(type(element), Direction) and len(named(type(element), Point)) < 2:
        return state.say(f"{element.title} looks the same from all sides: nothing to turn")
    world = WORLD.get(state.frame)
    if world:
        return state.put(rotated(element, world, angle), "turn", now)
    # Seen from the camera the front goes right, up or clockwise: only up is against the right-handed turn about right.
    about, turned = camera_frame(state.scene.camera)[axis], angle * handedness(state.scene.camera)
    return state.put(rotated(element, about, -turned if axis == RIGHT else turned), "turn", now)


def resize(sign: float, state: State, amount: float, now: float) -> State:
    """Change the active value of the selected element."""
    active = state.active
    if active is None:
        return state.say(f"{state.element.title} has no size")
    another = partial(asset_files.next_file, state.scene)
    changed = state.put(
        state.element.replace(**{active.field.name: active.nudged(state.element, sign * amount, another)}),
        f"value {active.name}",
        now,
    )
    if changed is state:
        value = active.of(state.element)
        if isinstance(value, str | MeshFile):
            sort = "picture" if isinstance(value, str) else "mesh"
            return state.say(f"there is no other {sort} beside the scene")
        limits = f" ({active.range})" if active.range else ""
        return state.say(f"{active.name} cannot go further{limits}")
    return changed


def next_value(state: State, _amount: float, _now: float) -> State:
    """Let the next value be the active one."""
    known = values(state.element)
    if not known:
        return state.say(f"{state.element.title} has no value to change")
    return replace(state, value=(state.value + 1) % len(known), recent=None)


def next_frame(state: State, _amount: float, _now: float) -> State:
    """Let objects move along the next axis."""
    frames = list(Frame)
    return replace(state, frame=frames[(frames.index(state.frame) + 1) % len(frames)], recent=None)


EDITS: dict[str, Edit] = {
    "select next": partial(selection.step, 1),
    "select previous": partial(selection.step, -1),
    "select camera": selection.camera,
    "select light": selection.next_light,
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
    "grow": partial(resize, 1.0),
    "shrink": partial(resize, -1.0),
    "next value": next_value,
    "give attribute": attributes.give,
    "take attribute": attributes.take,
    "look at": framing.look_at,
    "reset camera": framing.reset_camera,
    "undo": history.undo,
    "redo": history.redo,
    "add": partial(structure.add, 1),
    "add previous": partial(structure.add, -1),
    "duplicate": structure.duplicate,
    "delete": structure.delete,
}
