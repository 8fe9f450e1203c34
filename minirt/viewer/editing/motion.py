"""Translation and rotation of vectors, cameras, and any element with points and directions."""

from __future__ import annotations

from math import atan2, cos, dist, fmod, fsum, hypot, pi, radians, sin

from minirt.element import Element
from minirt.fields import FARTHEST, Direction, Point, Triple, clamp, unit, upright
from minirt.scene import Camera
from minirt.scene.camera_frame import camera_frame, linear_combination
from minirt.viewer.editing.number_format import NOISE, neat_direction
from minirt.viewer.editing.orientation import can_turn, rodrigues, with_directions
from minirt.viewer.editing.state import Frame, field_names

STEEPEST = pi / 2 - 1e-8  # radians: nobody sees the difference to straight up, which would have no heading
WORLD_AXES: dict[Frame, Triple] = {Frame.X: (1.0, 0.0, 0.0), Frame.Y: (0.0, 1.0, 0.0), Frame.Z: (0.0, 0.0, 1.0)}


def translate(element: Element, axis: Triple, distance: float) -> tuple[Element, bool]:
    """Move all points of an element along `axis`, clamped to the format's range. Returns whether it was clamped."""
    points = {name: getattr(element, name) for name in field_names(type(element), Point)}
    offset = [distance * part for part in axis]
    clamped = [
        clamp(part, -FARTHEST - min(coordinates), FARTHEST - max(coordinates))
        for part, coordinates in zip(offset, zip(*points.values(), strict=True), strict=True)
    ]
    moved = {
        name: clamp_point(linear_combination(1.0, point, 1.0, (clamped[0], clamped[1], clamped[2])))
        for name, point in points.items()
    }
    return element.replace(**moved), clamped != offset


def clamp_point(point: Triple) -> Triple:
    """Clamp the coordinates of a point to the range of the format."""
    x, y, z = (clamp(coordinate, -FARTHEST, FARTHEST) for coordinate in point)
    return x, y, z


def rotate(element: Element, axis: Triple, degrees: float) -> Element:
    """Rotate the directions of an element about a unit vector, right-handed, and its points about their mean.

    An element that looks the same from all sides stays as it is.
    """
    if not can_turn(element):
        return element
    directions = {name: getattr(element, name) for name in field_names(type(element), Direction)}
    rotated = {name: neat_rotation(direction, axis, degrees) for name, direction in directions.items()}
    changes = with_directions(element, rotated, axis, degrees)
    points = {name: getattr(element, name) for name in field_names(type(element), Point)}
    if len(points) > 1:
        x, y, z = (fsum(part) / len(points) for part in zip(*points.values(), strict=True))
        for name, point in points.items():
            offset = rodrigues(linear_combination(1.0, point, -1.0, (x, y, z)), axis, degrees)
            changes[name] = clamp_point(linear_combination(1.0, (x, y, z), 1.0, offset))
    return element.replace(**changes)


def rotate_direction(direction: Triple, axis: Triple, degrees: float) -> Triple:
    """Rotate a unit vector about the unit vector `axis`, and normalise it."""
    return unit(rodrigues(direction, axis, degrees))


def neat_rotation(direction: Triple, axis: Triple, degrees: float) -> Triple:
    """Rotate a unit vector about another, and round it; a direction along the axis keeps all its digits."""
    rotated = rotate_direction(direction, axis, degrees)
    return direction if dist(rotated, direction) < NOISE else neat_direction(rotated, keep_heading=False)


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


def orbit_camera(camera: Camera, pivot: Triple, right: float, up: float) -> Camera:
    """Turn the camera as `turn_camera` does, and move it so that `pivot` stays where it is in the picture."""
    turned = turn_camera(camera, right, up)
    position = pivot
    for old, new in zip(camera_frame(camera), camera_frame(turned), strict=True):
        along = sum((a - b) * part for a, b, part in zip(camera.position, pivot, old, strict=True))
        position = linear_combination(1.0, position, along, new)
    return turned.replace(position=clamp_point(position))


def roll_camera(camera: Camera, degrees: float) -> Camera:
    """Roll the camera about its direction, clockwise."""
    return camera.replace(roll=fmod(camera.roll + degrees * handedness(camera), 360.0))


def handedness(camera: Camera) -> float:
    """Return -1 for a mirrored picture, in which right and clockwise are the opposite in the scene, otherwise 1."""
    return -1.0 if camera.left_handed else 1.0
