"""Select the element that the keys edit."""

from __future__ import annotations

from minirt.scene import Lamp
from minirt.shapes import Shape
from minirt.viewer.editing.state import State, can_edit, index_of


def select_neighbour(step: int, state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Select the next (step 1) or previous (-1) editable element in the order of the file, cyclically."""
    count = len(state.scene.elements)
    indices = ((state.selected + step * number) % count for number in range(1, count + 1))
    return state.select(next(index for index in indices if can_edit(type(state.scene.elements[index]))))


def select_camera(state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Select the camera."""
    return state.select(index_of(state.scene, state.scene.camera))


def select_next_light(state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Select the next light after the selected element, cyclically."""
    lights = list(state.scene.indices_of(Lamp))
    if not lights:
        return state.with_message("there is no light")
    return state.select(next((index for index in lights if index > state.selected), lights[0]))


def select_shape(state: State, shape: Shape | None) -> State:
    """Select the shape that a pixel shows, or keep the selection if it shows none."""
    state = state.with_message("" if shape else "there is nothing")
    return state.select(index_of(state.scene, shape)) if shape else state
