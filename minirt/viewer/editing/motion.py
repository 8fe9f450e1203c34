"""Move and turn the selected elements and the camera, frame the selected element, focus, and change the tone."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import atan, atan2, copysign, cos, dist, hypot, pi, radians, sin, tan
from typing import TypeVar

from minirt.element import Element
from minirt.fields import Triple, clamp, clamp_length, spelled, unit, upright
from minirt.rendering.packing.camera import camera_frame
from minirt.scene import Scene
from minirt.scene.elements import TONES, Camera, linear_combination
from minirt.viewer.editing.placing import keep_standing
from minirt.viewer.editing.projection import dot, extent, position_of, scene_centre, subtract
from minirt.viewer.editing.rigid import can_turn, clamp_point, mean_point, rotate, rotate_about, shifted, translate
from minirt.viewer.editing.state import MoveAxes, State
from minirt.viewer.editing.values import round_length

Moved = TypeVar("Moved", bound=Element)

RIGHT, UPWARD, FORWARD = range(3)  # axes of `camera_frame`
STEEPEST = pi / 2 - 1e-8  # radians: nobody sees the difference to straight up, which would have no heading
WORLD_AXES: dict[MoveAxes, Triple] = {
    MoveAxes.X: (1.0, 0.0, 0.0),
    MoveAxes.Y: (0.0, 1.0, 0.0),
    MoveAxes.Z: (0.0, 0.0, 1.0),
}
LEVEL = 0.5  # vertical part of a camera's up; above it, which is up to a pitch of 60 degrees, left and right are level
LENS = 1 / 40  # diameter of a new lens by the distance in focus
MARGIN = 1.5  # the distance is larger than for the bounding sphere: room for corners of the box and a border
USUAL_SIZE = 16, 9  # of a window, in any unit
ASPECT = USUAL_SIZE[1] / USUAL_SIZE[0]
APPROACH = 1 / 10  # of the distance to what is under the pointer: a step of the wheel
APPROACHING = "approach"  # kind of the changes by the wheel
FARTHEST_SEEN = 2.0  # times the distance to the scene: the camera neither orbits nor nears what is farther away
NEAREST = 1 / 4  # of the scene's size: the least distance whose share a step is
POINT_RADIUS = 1 / 10  # of the scene's size: the radius that is shown around an element without extent


def edit_all(state: State, element: Element, edit: Callable[[Element], Element], kind: str, now: float) -> State:
    """Edit all selected elements as they are now or, in a drag, as they were at its start: when the primary one was
    `element`."""
    scene = state.scene if element is state.element or not state.others else state.undo_stack[-1].scene
    changed = {index: edit(scene.elements[index]) for index in state.others}
    return state.edit_elements({state.selected: edit(element), **changed}, kind, now)


def put(state: State, element: Element, placed: Element, kind: str, now: float) -> State:
    """Put the primary element, which was `element`, to where it is as `placed`, and move the others as far."""
    start, end = position_of(element), position_of(placed)
    way = subtract(end, start) if start and end else (0.0, 0.0, 0.0)
    return edit_all(state, element, lambda each: placed if each is element else shifted(each, way), kind, now)


def move(state: State, element: Element, axis: Triple, distance: float, kind: str, now: float) -> State:
    """Move the selected elements along an axis from where they were when the primary one was `element`: now, or at the
    start of a drag. The `distance` is in scene units."""
    state = edit_all(state, element, lambda each: shifted(each, axis, distance), kind, now)
    _, clamped = translate(element, axis, distance)
    return state.with_message("the end of the range: no further") if clamped else state


def turn(state: State, element: Element, turns: Sequence[tuple[int, float]], kind: str, now: float) -> State:
    """Turn the selected elements; several turn about the place of the primary one.

    `element` is the primary one as it was at the start of a drag, or as it is now; all turn from where they were then.
    `turns` are about axes of the view: the number of an axis in `camera_frame`, and the angle in degrees by which the
    side that faces the camera goes right about UPWARD, up about RIGHT, or clockwise about FORWARD. Where `state.frame`
    names an axis of the world, all turns are about that one, right-handed. Turns of the same `kind` that follow each
    other soon are undone together; `now` is the time in seconds.
    """
    if not can_turn(element) and not state.others:
        return state.with_message(f"{element.title} looks the same from all sides: nothing to turn")
    camera, world = state.scene.camera, WORLD_AXES.get(state.frame)
    rotations: list[tuple[Triple, float]] = []
    for axis, angle in turns:
        # A right-handed rotation turns the side that faces the camera right about UPWARD, but down about RIGHT.
        right_handed = handedness(camera) * (-angle if axis == RIGHT else angle)
        rotations.append((world, angle) if world else (turn_axis(camera, axis), right_handed))
    return rotate_all(state, element, rotations, kind, now)


def rotate_all(
    state: State, element: Element, rotations: Sequence[tuple[Triple, float]], kind: str, now: float
) -> State:
    """Rotate the selected elements, one rotation after the other.

    Several elements rotate about the mean point of the primary one; a single one that stands on something stays on it.
    `element`, `kind` and `now` are those of `turn`. `rotations` are axes, of unit length, and angles in degrees,
    right-handed.
    """
    pivot = mean_point(element) if state.others else None

    def rotated(each: Element) -> Element:
        for axis, angle in rotations:
            each = rotate_about(each, pivot, axis, angle) if pivot else rotate(each, axis, angle)
        return each if pivot else keep_standing(state, element, each)

    return edit_all(state, element, rotated, kind, now)


def turn_camera(camera: Camera, right: float, up: float) -> Camera:
    """Turn the camera by degrees: to the right about the world's y axis, and up, at most to straight up.

    A direction straight up keeps a horizontal part of 1e-8: too little for any picture, but enough to keep the heading,
    so that turning down leads back.
    """
    x, y, z = camera.direction
    (a, _, b), _ = upright(x, y, z)
    heading = atan2(-a, b) + radians(right) * handedness(camera)
    height = clamp(atan2(y, hypot(x, z)) + radians(up), -STEEPEST, STEEPEST)
    direction = cos(height) * cos(heading), sin(height), cos(height) * sin(heading)
    return camera.replace(direction=unit(direction))


def level_frame(camera: Camera) -> tuple[Triple, Triple, Triple]:
    """Right, up and forward as a camera sees them on level ground: up is the vertical, whatever its pitch and roll."""
    (a, _, b), _ = upright(*camera.direction)
    return camera_frame(camera.replace(direction=(b, 0.0, -a), roll=0.0))


def orbit_camera(camera: Camera, pivot: Triple, right: float, up: float) -> Camera:
    """Turn the camera as `turn_camera` does, and move it so that `pivot` stays where it is in the picture."""
    turned = turn_camera(camera, right, up)
    position = pivot
    for old, new in zip(camera_frame(camera), camera_frame(turned), strict=True):
        along = sum((a - b) * part for a, b, part in zip(camera.position, pivot, old, strict=True))
        position = linear_combination(1.0, position, along, new)
    return turned.replace(position=clamp_point(position))


def turntable(scene: Scene, count: int) -> Iterator[Scene]:
    """Yield the scene from `count` positions on a circle around its centre; the frames repeat seamlessly."""
    pivot = scene_centre(scene)
    for number in range(count):
        camera = orbit_camera(scene.camera, pivot, 360.0 * number / count, 0.0)
        yield scene.replace(scene.camera, camera) if number else scene


def handedness(camera: Camera) -> float:
    """Return -1 for a mirrored picture, in which right and clockwise are the opposite in the scene, otherwise 1."""
    return -1.0 if camera.left_handed else 1.0


def turn_axis(camera: Camera, axis: int) -> Triple:
    """The axis of a turn as seen by the camera: right, up or forward, by its number in `camera_frame`.

    In place of up it is the vertical, unless the camera looks steeply up or down or is rolled: what stands upright then
    turns on its foot, as on a turntable, and does not tip over.
    """
    direction = camera_frame(camera)[axis]
    return (0.0, copysign(1.0, direction[1]), 0.0) if axis == UPWARD and abs(direction[1]) > LEVEL else direction


def look_at(state: State, _amount: float, now: float) -> State:
    """Move the camera, without turning it, so that the selected element is centred and fills the picture.

    Where that changes nothing, and if a camera is selected, move and turn the camera so that it shows the scene. For an
    element without a position there is only a message.
    """
    from minirt.rendering.queries.unseen import showing_camera

    element = state.element
    around = None if isinstance(element, Camera) else extent(element)
    after = state if around is None else state.edit_camera(framing_camera(state, *around), "", now)
    if after is not state:
        return after.with_message("again: the whole scene")
    if around or isinstance(element, Camera):
        showing = showing_camera(state.scene, USUAL_SIZE, straight=True)
        return state.edit_camera(showing, "", now) if showing else state
    return state.with_message(f"select an element with a position to look at: {element.title} has none")


def framing_camera(state: State, centre: Triple, radius: float) -> Camera:
    """The camera, moved without a turn so that a ball is centred and fills the picture."""
    camera = state.scene.camera
    half = atan(tan(radians(clamp(camera.fov, 1.0, 120.0)) / 2) * ASPECT)
    distance = MARGIN * (radius or POINT_RADIUS * state.size) / sin(half)
    _, _, forward = camera_frame(camera)
    return camera.replace(position=clamp_point(linear_combination(1.0, centre, -distance, forward)))


def in_reach(state: State, point: Triple | None) -> Triple | None:
    """A point of a surface, unless it is far in the background: on a sky, or on the ground near the horizon."""
    eye = state.scene.camera.position
    reach = FARTHEST_SEEN * max(state.size, dist(eye, scene_centre(state.scene)))
    return point if point and dist(eye, point) <= reach else None


def approach(state: State, ray: Triple, point: Triple | None, steps: float, now: float) -> State:
    """Move the camera along the ray through the pointer: what is under the pointer stays there.

    A step is a tenth of the distance to the surface there, at `point`. Where none is near it is a tenth of the distance
    to the scene's centre; close to that, as much as there.
    """
    camera, seen = state.scene.camera, in_reach(state, point)
    if seen:
        distance = dist(camera.position, seen)
    else:
        _, _, forward = camera_frame(camera)
        distance = max(dot(subtract(scene_centre(state.scene), camera.position), forward), state.size * NEAREST)
    return state.edit_camera(shifted(camera, ray, distance * (1 - (1 - APPROACH) ** steps)), APPROACHING, now)


def next_tone(state: State, _amount: float, now: float) -> State:
    """Give the camera in view the next tone, and say which one."""
    camera = state.scene.camera
    tone = TONES[(TONES.index(camera.tone) + 1) % len(TONES)]
    return state.edit_camera(camera.replace(tone=tone), "tone", now).with_message(f"tone: {tone}")


def focus(state: State, point: Triple | None, now: float) -> State:
    """Focus the camera on a point: its distance along the viewing direction. A camera without a lens gets one."""
    if point is None:
        return state.with_message("nothing there to focus on")
    camera = state.scene.camera
    distance = round_length(clamp_length(dot(camera.direction, subtract(point, camera.position))))
    lens = camera.lens or round_length(LENS * distance)
    state = state.edit_camera(camera.replace(focus=distance, lens=lens), "focus", now)
    return state.with_message(f"focus: {spelled(distance)}, lens: {spelled(lens)}")


def reset_camera(state: State, _amount: float, now: float) -> State:
    """Give the camera in view the values that it has in the file; one that no file has stays as it is."""
    scene = state.scene
    in_file = state.file_cameras[scene.shown] if scene.shown < len(state.file_cameras) else scene.camera
    return state if scene.camera == in_file else state.change(scene.replace(scene.camera, in_file), "", now)
