"""Translate and rotate elements and the camera, frame the selected element, focus, and change the tone."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import atan, atan2, copysign, cos, degrees, dist, fsum, hypot, pi, radians, sin, tan
from typing import Any, TypeVar

from minirt.element import Element
from minirt.fields import FARTHEST, Direction, Point, Triple, clamp, clamp_length, spelled, unit, upright
from minirt.rendering.packing.camera import camera_frame
from minirt.scene import Scene
from minirt.scene.elements import TONES, Camera, linear_combination
from minirt.shapes.shape import Oriented
from minirt.viewer.editing.projection import dot, extent, field_names, scene_centre, subtract
from minirt.viewer.editing.state import Frame, State
from minirt.viewer.editing.values import NOISE, neat_direction, round_length, shows_roll

Moved = TypeVar("Moved", bound=Element)

RIGHT, UPWARD, FORWARD = range(3)  # axes of `camera_frame`
STEEPEST = pi / 2 - 1e-8  # radians: nobody sees the difference to straight up, which would have no heading
WORLD_AXES: dict[Frame, Triple] = {Frame.X: (1.0, 0.0, 0.0), Frame.Y: (0.0, 1.0, 0.0), Frame.Z: (0.0, 0.0, 1.0)}
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


def translate(element: Moved, axis: Triple, distance: float) -> tuple[Moved, bool]:
    """Move all points of an element along `axis`, clamped to the format's range. Returns whether it was clamped."""
    points = {name: getattr(element, name) for name in field_names(type(element), Point)}
    offset = [distance * part for part in axis]
    limits = ((-FARTHEST - min(each), FARTHEST - max(each)) for each in zip(*points.values(), strict=True))
    x, y, z = (clamp(part, *limit) for part, limit in zip(offset, limits, strict=True))
    moved = {name: clamp_point(linear_combination(1.0, point, 1.0, (x, y, z))) for name, point in points.items()}
    return element.replace(**moved), [x, y, z] != offset


def clamp_point(point: Triple) -> Triple:
    """Clamp the coordinates of a point to the range of the format."""
    x, y, z = (clamp(coordinate, -FARTHEST, FARTHEST) for coordinate in point)
    return x, y, z


def shifted(element: Moved, axis: Triple, distance: float = 1.0) -> Moved:
    """Move an element as `translate` does."""
    return translate(element, axis, distance)[0]


def rotate(element: Element, axis: Triple, angle: float) -> Element:
    """Rotate the directions of an element about a unit vector, right-handed, and its points about their mean.

    angle: degrees. The roll of the element keeps its frame whole.
    """
    changes: dict[str, Any] = {}
    for name in field_names(type(element), Direction):
        old = getattr(element, name)
        new = unit(rodrigues(old, axis, angle))  # a direction along the axis keeps all its digits
        changes[name] = old if dist(new, old) < NOISE else neat_direction(new, keep_heading=False)
    if isinstance(element, Oriented) and shows_roll(element):
        # Compared with the frame without a roll about the new axis, however far that is from the one before.
        u, v, _ = frame_of(element.replace(**changes, roll=0.0))
        rotated = rodrigues(frame_of(element)[0], axis, angle)
        changes["roll"] = degrees(atan2(dot(rotated, v), dot(rotated, u)))
    points = {name: getattr(element, name) for name in field_names(type(element), Point)}
    if len(points) > 1:
        x, y, z = (fsum(part) / len(points) for part in zip(*points.values(), strict=True))
        for name, point in points.items():
            offset = rodrigues(subtract(point, (x, y, z)), axis, angle)
            changes[name] = clamp_point(linear_combination(1.0, (x, y, z), 1.0, offset))
    return element.replace(**changes)


def move(state: State, element: Element, axis: Triple, distance: float, kind: str, now: float) -> State:
    """Move the selected element along an axis from where it was as `element`."""
    moved, clamped = translate(element, axis, distance)
    state = state.edit_element(moved, kind, now)
    return state.with_message("the end of the range: no further") if clamped else state


def turn(state: State, element: Element, turns: Sequence[tuple[int, float]], kind: str, now: float) -> State:
    """Turn the selected element from what it was as `element`, about axes of the view or the one of the frame.

    turns: the number of an axis in `camera_frame`, and the angle in degrees by which the front goes right about UPWARD,
    up about RIGHT, or clockwise about FORWARD.
    """
    if not can_turn(element):
        return state.with_message(f"{element.title} looks the same from all sides: nothing to turn")
    camera, world = state.scene.camera, WORLD_AXES.get(state.frame)
    for axis, angle in turns:
        if world:
            element = rotate(element, world, angle)
        else:  # seen from the camera, only up is opposite to the right-handed rotation
            seen = handedness(camera) * (-angle if axis == RIGHT else angle)
            element = rotate(element, turn_axis(camera, axis), seen)
    return state.edit_element(element, kind, now)


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


def can_turn(element: Element) -> bool:
    """Whether some rotation of an element can be seen."""
    kind = type(element)
    if isinstance(element, Oriented):
        return element.shows_axis
    return len(field_names(kind, Point)) > 1 or bool(field_names(kind, Direction))


def turn_axis(camera: Camera, axis: int) -> Triple:
    """The axis of a turn as seen by the camera: right, up or forward, by its number in `camera_frame`.

    In place of up it is the vertical, unless the camera looks steeply up or down or is rolled: what stands upright then
    turns on its foot, as on a turntable, and does not tip over.
    """
    direction = camera_frame(camera)[axis]
    return (0.0, copysign(1.0, direction[1]), 0.0) if axis == UPWARD and abs(direction[1]) > LEVEL else direction


def frame_of(element: Element) -> list[Triple]:
    """The vectors of the own frame of a shape that has one; the last is its axis or normal."""
    return [(each.x, each.y, each.z) for each in element.frame()] if isinstance(element, Oriented) else []


def rodrigues(vector: Triple, axis: Triple, degrees: float) -> Triple:
    """Rotate a vector about the unit vector `axis` by Rodrigues' formula (1840)."""
    c, s = cos(radians(degrees)), sin(radians(degrees))
    (x, y, z), (a, b, d) = vector, axis
    cross = b * z - d * y, d * x - a * z, a * y - b * x
    along = (x * a + y * b + z * d) * (1 - c)
    return linear_combination(1.0, linear_combination(c, vector, s, cross), along, axis)


def look_at(state: State, _amount: float, now: float) -> State:
    """Move the camera, without turning it, so that the selected element is centred and fills the picture; if the camera
    is selected itself, move and turn it so that it shows the scene."""
    from minirt.rendering.queries.unseen import showing_camera

    element, camera = state.element, state.scene.camera
    if isinstance(element, Camera) and (showing := showing_camera(state.scene, USUAL_SIZE)):
        return state.edit_camera(showing, "", now)
    bounds = extent(element)
    if bounds is None:
        return state.with_message(f"select an element with a position to look at: {element.title} has none")
    centre, radius = bounds
    half = atan(tan(radians(clamp(camera.fov, 1.0, 120.0)) / 2) * ASPECT)
    distance = MARGIN * (radius or POINT_RADIUS * state.size) / sin(half)
    _, _, forward = camera_frame(camera)
    moved = camera.replace(position=clamp_point(linear_combination(1.0, centre, -distance, forward)))
    return state.edit_camera(moved, "", now)


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
    scene = state.scene
    in_file = state.file_cameras[scene.shown] if scene.shown < len(state.file_cameras) else scene.camera
    return state if scene.camera == in_file else state.change(scene.replace(scene.camera, in_file), "", now)
