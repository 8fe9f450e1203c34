"""Choosing the element that the keys work on."""

from __future__ import annotations

from minirt.scene import Lamp
from minirt.shapes import Shape
from minirt.viewer.editing.state import State, can_edit, index_of


def step(way: int, state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """The next or the previous element that can be edited, in the order of the file and round again."""
    count = len(state.scene.elements)
    around = ((state.selected + way * ahead) % count for ahead in range(1, count + 1))
    return state.select(next(index for index in around if can_edit(type(state.scene.elements[index]))))


def camera(state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Back to the camera."""
    return state.select(index_of(state.scene, state.scene.camera))


def next_light(state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """The next light behind the selected element, and round again."""
    lights = list(state.scene.indices_of(Lamp))
    if not lights:
        return state.say("there is no light")
    return state.select(next((index for index in lights if index > state.selected), lights[0]))


def picked(state: State, shape: Shape | None) -> State:
    """What a pixel shows."""
    state = state.say("" if shape else "there is nothing")
    return state.select(index_of(state.scene, shape)) if shape else state
