"""Frame the selected element in the picture, change the tone, and reset the camera."""

from __future__ import annotations

from math import atan, radians, sin, tan

from minirt.fields import clamp
from minirt.scene import Camera
from minirt.scene.camera_frame import camera_frame, linear_combination
from minirt.scene.elements import TONES
from minirt.viewer.editing.measure import extent
from minirt.viewer.editing.motion import clamp_point
from minirt.viewer.editing.state import State

MARGIN = 1.5  # the distance is larger than for the bounding sphere: room for corners of the box and a border
ASPECT = 9 / 16  # height / width of a usual window
POINT_RADIUS = 1 / 10  # of the scene's size: the radius that is shown around an element without extent


def look_at(state: State, _amount: float, now: float) -> State:
    """Move the camera, without turning it, so that the selected element is centred and fills the picture."""
    element, camera = state.element, state.scene.camera
    bounds = None if isinstance(element, Camera) else extent(element)
    if bounds is None:
        return state.with_message(f"select an element with a position to look at: {element.title} has none")
    centre, radius = bounds
    half = atan(tan(radians(clamp(camera.fov, 1.0, 120.0)) / 2) * ASPECT)
    distance = MARGIN * (radius or POINT_RADIUS * state.size) / sin(half)
    _, _, forward = camera_frame(camera)
    moved = camera.replace(position=clamp_point(linear_combination(1.0, centre, -distance, forward)))
    return state.edit_camera(moved, "", now)


def next_tone(state: State, _amount: float, now: float) -> State:
    """Switch to the next tone of the picture."""
    camera = state.scene.camera
    tone = TONES[(TONES.index(camera.tone) + 1) % len(TONES)]
    return state.edit_camera(camera.replace(tone=tone), "tone", now).with_message(f"tone: {tone}")


def reset_camera(state: State, _amount: float, now: float) -> State:
    """Reset the camera to that of the file."""
    if state.scene.camera == state.file_camera:
        return state
    return state.change(state.scene.replace(state.scene.camera, state.file_camera), "", now)
