"""Editing actions of the keys: pure functions State -> State, named as in the table of bindings.

`amount` is a number of steps: 1 for a press, fractions while a key is held or with Shift. `now` is the time in seconds,
by which changes are merged for undo. Actions depend on the types of fields that elements have, never on a shape.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from math import fmod

from minirt.errors import ElementError
from minirt.fields import MeshFile, Point
from minirt.scene import Camera
from minirt.shapes import Shape
from minirt.viewer.editing import motion, selection, structure
from minirt.viewer.editing import state as states
from minirt.viewer.editing.motion import FORWARD, RIGHT, UPWARD, WORLD_AXES
from minirt.viewer.editing.placing import dropped, keep_standing
from minirt.viewer.editing.projection import field_names
from minirt.viewer.editing.state import MoveAxes, State
from minirt.viewer.editing.values import values

Edit = Callable[[State, float, float], State]  # (state, amount, now)
TURN_STEP = 5.0  # degrees
RATE = 8.0  # steps a second, at first
PATIENCE = 1.0  # seconds after which the steps of a held key begin to grow
GROWTH = 2.0  # of the rate in each further second, as a multiple of the first rate
FIRST_PART = 0.5  # of the first step, which comes with the press


def apply(state: State, action: str, amount: float = 1.0, now: float = 0.0) -> State:
    """The state after an action. KeyError if `action` is not in EDITS."""
    try:
        return EDITS[action](state.with_message(""), amount, now)
    except ElementError as error:
        return state.with_message(str(error))


@dataclass
class HeldKey:
    """A key that is held down. Its steps are proportional to time and independent of the frame rate.

    A part of the first step comes with the press, the rest follows until it is time for the second one: nothing stands
    still meanwhile. Each part of it replaces the part before: a tap leaves what one whole step leaves, to the last
    digit. After t seconds, at most PATIENCE, a key has taken max(1, RATE t) steps; after that its rate grows.
    """

    action: str
    since: float  # seconds
    size: float  # of its first step
    is_typed: bool  # a character, of which Shift may be a part: its steps are whole ones
    done: float = 0.0  # steps until now
    first: tuple[State, State] | None = None  # states before the first step and after a part of it

    def steps(self, now: float) -> float:
        """The steps that the key has taken at a time: `FIRST_PART` at the press."""
        seconds = now - self.since
        steps = RATE * (seconds + GROWTH / 2 * max(0.0, seconds - PATIENCE) ** 2)
        return max(FIRST_PART + (1 - FIRST_PART) * steps, steps)

    def advance(self, state: State, steps: float, size: float, now: float) -> State:
        """Return the state after `steps` steps in all since the press, each of `size`; fewer than before do nothing.

        `done` and `first` are brought up to date. If `state` is still the one after a part of the first step, that step
        is taken again, from the state before it and with its own size.
        """
        done, self.done = self.done, max(self.done, steps)
        if self.done == done:
            return state
        if self.first and self.first[1] is state:
            done, state, size = 0.0, self.first[0], self.size
        size = 1.0 if self.is_typed else size
        before = state
        if done < 1:
            state = apply(before, self.action, (min(self.done, 1.0) - done) * size, now)
        if self.done > 1:
            state = apply(state, self.action, (self.done - max(done, 1.0)) * size, now)
        self.first = (before, state) if done == 0.0 and self.done < 1 else None
        return state


def move(axis: int, sign: float, state: State, amount: float, now: float) -> State:
    """Move the selected elements: up, or along the ground as the camera sees it, or along the axis of the frame."""
    element = state.element
    if not field_names(type(element), Point) and not state.others:
        return state.with_message(f"{element.title} has no position to move")
    frame = MoveAxes.VIEW if element is state.scene.camera else state.frame
    direction = WORLD_AXES.get(frame) or motion.level_frame(state.scene.camera)[axis]
    return motion.move(state, element, direction, sign * amount * state.stride, "move", now)


def turn(axis: int, sign: float, state: State, amount: float, now: float) -> State:
    """Turn the selected elements: to the right about UPWARD, upwards about RIGHT, clockwise about FORWARD."""
    element, angle = state.element, sign * amount * TURN_STEP
    if isinstance(element, Camera) and not state.others:
        if axis == FORWARD:
            roll = fmod(element.roll + angle * motion.handedness(element), 360.0)
            return state.edit_element(element.replace(roll=roll), "roll", now)
        turned = motion.turn_camera(element, angle * (axis == UPWARD), angle * (axis == RIGHT))
        return state.edit_element(turned, "turn", now)
    after = motion.turn(state, element, [(axis, angle)], "turn", now)
    if after is state:
        return state.with_message(f"{element.title} looks the same after a turn about its own axis")
    return after


def change_value(sign: float, state: State, amount: float, now: float) -> State:
    """Change the active value of the primary element by `sign * amount` steps; a message says where it cannot go on.

    An element that stands on something stands there with its new size, too.
    """
    active = state.active
    # Of several selected elements only the primary one changes, as in Blender: others may lack the value.
    new = active.stepped(state.element, sign * amount, state.scene, state.stride)
    stepped = state.element.replace(**{active.field.name: new})
    changed = state.edit_element(keep_standing(state, state.element, stepped), f"value {active.name}", now)
    if changed is state:
        value = active.get(state.element)
        if isinstance(value, str | MeshFile):
            noun = "picture" if isinstance(value, str) else "mesh"
            return state.with_message(f"there is no other {noun} beside the scene")
        limits = f" ({active.leaf.range})" if active.leaf.range else ""
        return state.with_message(f"{active.name} cannot go further{limits}")
    return changed


def drop(state: State, _amount: float, now: float) -> State:
    """Drop the selected shape onto what lies beneath, on a grid or in the middle; others that are selected follow."""
    shape = state.element
    if not isinstance(shape, Shape) or shape.bounds() is None:
        return state.with_message(f"{shape.title} cannot stand on anything")
    there = dropped(shape, state.rest, state.stride)
    if there is None:
        return state.with_message(f"there is nothing beneath the {shape.title}")
    message = f"on what lies beneath, on a grid of {state.stride:g}"
    return motion.put(state, shape, there, "", now).with_message(message)


def next_value(step: int, state: State, _amount: float, _now: float) -> State:
    """Make the next (step 1) or previous (-1) value of the selected element active."""
    index = (state.value_index + step) % len(values(state.element))
    return replace(state, value_index=index, last_change=None)


def next_frame(state: State, _amount: float, _now: float) -> State:
    """Take the next axes along which elements move: those of the view, or one of the world."""
    frames = list(MoveAxes)
    return replace(state, frame=frames[(frames.index(state.frame) + 1) % len(frames)], last_change=None)


EDITS: dict[str, Edit] = {
    "select next": partial(selection.select_neighbour, 1),
    "select previous": partial(selection.select_neighbour, -1),
    "select camera": selection.select_camera,
    "select light": selection.select_next_light,
    "look through": selection.look_through_selected,
    "left": partial(move, RIGHT, -1.0),
    "right": partial(move, RIGHT, 1.0),
    "forward": partial(move, FORWARD, 1.0),
    "back": partial(move, FORWARD, -1.0),
    "down": partial(move, UPWARD, -1.0),
    "up": partial(move, UPWARD, 1.0),
    "turn left": partial(turn, UPWARD, -1.0),
    "turn right": partial(turn, UPWARD, 1.0),
    "turn up": partial(turn, RIGHT, 1.0),
    "turn down": partial(turn, RIGHT, -1.0),
    "roll left": partial(turn, FORWARD, -1.0),
    "roll right": partial(turn, FORWARD, 1.0),
    "next frame": next_frame,
    "grow": partial(change_value, 1.0),
    "shrink": partial(change_value, -1.0),
    "drop": drop,
    "next value": partial(next_value, 1),
    "previous value": partial(next_value, -1),
    "remove attribute": structure.remove_attribute,
    "next tone": motion.next_tone,
    "look at": motion.look_at,
    "reset camera": motion.reset_camera,
    "undo": states.undo,
    "redo": states.redo,
    "duplicate": structure.duplicate,
    "delete": structure.delete,
}
