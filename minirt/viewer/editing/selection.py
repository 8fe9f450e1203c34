"""Selection by keys: the next element, the camera or the next one, the next light."""

from __future__ import annotations

from operator import indexOf

from minirt.scene import Camera, Lamp
from minirt.viewer.editing.state import State, can_edit, index_of


def select_neighbour(step: int, state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Select the next (step 1) or previous (-1) editable element in the order of the file, cyclically."""
    count = len(state.scene.elements)
    indices = ((state.selected + step * number) % count for number in range(1, count + 1))
    return state.select(next(index for index in indices if can_edit(type(state.scene.elements[index]))))


def select_camera(state: State, _amount: float = 1.0, now: float = 0.0) -> State:
    """Select the camera in view, or where it is selected look through the next one, cyclically."""
    count = len(state.scene.cameras)
    if state.element is not state.scene.camera or count == 1:
        return state.select(index_of(state.scene, state.scene.camera))
    following = state.scene.cameras[(state.scene.shown + 1) % count]
    return look_through(state, index_of(state.scene, following), now)


def look_through(state: State, index: int, now: float) -> State:
    """Select the camera `scene.elements[index]` and look through it."""
    cameras = state.scene.cameras
    number = 1 + indexOf(map(id, cameras), id(state.scene.elements[index]))
    state = state.select(state.selected).change(state.scene.seen_by(number), "", now, index)
    return state.with_message(f"camera {number} of {len(cameras)}")


def look_through_selected(state: State, _amount: float = 1.0, now: float = 0.0) -> State:
    """Look through the selected camera."""
    if not isinstance(state.element, Camera):
        return state.with_message(f"{state.element.title} is no camera")
    return look_through(state, state.selected, now)


def select_next_light(state: State, _amount: float = 1.0, _now: float = 0.0) -> State:
    """Select the next light after the selected element, cyclically."""
    lights = list(state.scene.indices_of(Lamp))
    if not lights:
        return state.with_message("there is no light")
    return state.select(next((index for index in lights if index > state.selected), lights[0]))
