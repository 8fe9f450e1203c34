"""Where the camera goes by itself."""

from __future__ import annotations

from math import atan, radians, sin, tan

from minirt.fields import clamp
from minirt.scene import Camera
from minirt.scene.camera_frame import camera_frame, linear_combination
from minirt.viewer.editing.measure import ball
from minirt.viewer.editing.motion import limited
from minirt.viewer.editing.state import State

ROOM = 1.5  # the ball about the element, its corners and what is left free around them
FLAT = 9 / 16  # height by width of a usual window
POINT = 1 / 10  # of the scene's size: the radius that is shown around a thing without an extent


def look_at(state: State, _amount: float, now: float) -> State:
    """Move the camera, without turning it, until the selected element is in the middle and fills the picture."""
    element, camera = state.element, state.scene.camera
    around = None if isinstance(element, Camera) else ball(element)
    if around is None:
        return state.say(f"select something with a place to look at: {element.title} has none")
    centre, radius = around
    half = atan(tan(radians(clamp(camera.fov, 1.0, 120.0)) / 2) * FLAT)
    distance = ROOM * (radius or POINT * state.size) / sin(half)
    _, _, forward = camera_frame(camera)
    moved = camera.replace(position=limited(linear_combination(1.0, centre, -distance, forward)))
    return state.put_camera(moved, "", now)


def reset_camera(state: State, _amount: float, now: float) -> State:
    """The camera as the file has it."""
    if state.scene.camera == state.home:
        return state
    return state.change(state.scene.replace(state.scene.camera, state.home), "", now)
