"""Frame the selected element in the picture, change the tone, and reset the camera."""

from __future__ import annotations

from math import atan, radians, sin, tan

from minirt.fields import LEAST_LENGTH, Triple, clamp, spelled
from minirt.scene import Camera
from minirt.scene.camera_frame import camera_frame, linear_combination
from minirt.scene.elements import TONES
from minirt.viewer.editing.measure import extent, scene_centre
from minirt.viewer.editing.motion import clamp_point
from minirt.viewer.editing.number_format import round_length
from minirt.viewer.editing.projection import dot, subtract
from minirt.viewer.editing.state import State

LENS = 1 / 40  # diameter of a new lens by the distance in focus
MARGIN = 1.5  # the distance is larger than for the bounding sphere: room for corners of the box and a border
ASPECT = 9 / 16  # height / width of a usual window
APPROACH = 1 / 10  # of the distance to the scene's centre: a step of the wheel
NEAREST = 1 / 4  # of the scene's size: the least distance whose share a step is
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


def approach(state: State, steps: float, now: float) -> State:
    """Move the camera ahead by a tenth of its distance to the scene's centre; close to it, by as much as there."""
    camera = state.scene.camera
    _, _, forward = camera_frame(camera)
    ahead = dot(subtract(scene_centre(state.scene), camera.position), forward)
    distance = max(ahead, state.size * NEAREST) * (1 - (1 - APPROACH) ** steps)
    moved = camera.replace(position=clamp_point(linear_combination(1.0, camera.position, distance, forward)))
    return state.edit_camera(moved, "approach", now)


def next_tone(state: State, _amount: float, now: float) -> State:
    """Switch to the next tone of the picture."""
    camera = state.scene.camera
    tone = TONES[(TONES.index(camera.tone) + 1) % len(TONES)]
    return state.edit_camera(camera.replace(tone=tone), "tone", now).with_message(f"tone: {tone}")


def focus(state: State, point: Triple | None, now: float) -> State:
    """Focus the camera on a point: its distance along the viewing direction. A camera without a lens gets one."""
    if point is None:
        return state.with_message("nothing there to focus on")
    camera = state.scene.camera
    distance = sum(f * (p - e) for f, p, e in zip(camera.direction, point, camera.position, strict=True))
    distance = round_length(max(distance, LEAST_LENGTH))
    lens = camera.lens or round_length(LENS * distance)
    focused = camera.replace(focus=distance, lens=lens)
    changed = state.change(state.scene.replace(camera, focused), "focus", now)
    return changed.with_message(f"focus: {spelled(distance)}, lens: {spelled(lens)}")


def reset_camera(state: State, _amount: float, now: float) -> State:
    """Reset the camera to that of the file."""
    if state.scene.camera == state.file_camera:
        return state
    return state.change(state.scene.replace(state.scene.camera, state.file_camera), "", now)
