"""Moving and turning: vectors, cameras, and anything that has points and directions."""

from __future__ import annotations

from math import atan2, cos, fmod, fsum, hypot, pi, radians, sin

from minirt.element import Element
from minirt.fields import FARTHEST, Direction, Point, Triple, clamp, unit, upright
from minirt.scene import Camera
from minirt.scene.camera_frame import camera_frame, linear_combination
from minirt.viewer.editing.state import Frame, named

WORLD: dict[Frame, Triple] = {Frame.X: (1.0, 0.0, 0.0), Frame.Y: (0.0, 1.0, 0.0), Frame.Z: (0.0, 0.0, 1.0)}


def translated(element: Element, axis: Triple, distance: float) -> tuple[Element, bool]:
    """All points moved alike along `axis`, at most until one is at the end of the range, and whether that was met."""
    points = {name: getattr(element, name) for name in named(type(element), Point)}
    way = [distance * part for part in axis]
    kept = [
        clamp(part, -FARTHEST - min(coordinates), FARTHEST - max(coordinates))
        for part, coordinates in zip(way, zip(*points.values(), strict=True), strict=True)
    ]
    moved = {
        name: limited(linear_combination(1.0, point, 1.0, (kept[0], kept[1], kept[2])))
        for name, point in points.items()
    }
    return element.replace(**moved), kept != way


def limited(point: Triple) -> Triple:
    """The nearest point whose coordinates are in the range of the format."""
    x, y, z = (clamp(coordinate, -FARTHEST, FARTHEST) for coordinate in point)
    return x, y, z


def rotated(element: Element, axis: Triple, degrees: float) -> Element:
    """All directions turned about the unit vector `axis`, right-handed, and several points about their middle."""
    directions = {name: getattr(element, name) for name in named(type(element), Direction)}
    changes = {name: turned(direction, axis, degrees) for name, direction in directions.items()}
    points = {name: getattr(element, name) for name in named(type(element), Point)}
    if len(points) > 1:
        x, y, z = (fsum(part) / len(points) for part in zip(*points.values(), strict=True))
        for name, point in points.items():
            about = rodrigues(linear_combination(1.0, point, -1.0, (x, y, z)), axis, degrees)
            changes[name] = limited(linear_combination(1.0, (x, y, z), 1.0, about))
    return element.replace(**changes)


def turned(vector: Triple, axis: Triple, degrees: float) -> Triple:
    """A unit vector turned about the unit vector `axis`, at unit length again."""
    return unit(rodrigues(vector, axis, degrees))


def rodrigues(vector: Triple, axis: Triple, degrees: float) -> Triple:
    """A vector turned about the unit vector `axis` (Rodrigues, 1840)."""
    c, s = cos(radians(degrees)), sin(radians(degrees))
    (x, y, z), (a, b, d) = vector, axis
    cross = b * z - d * y, d * x - a * z, a * y - b * x
    along = (x * a + y * b + z * d) * (1 - c)
    return linear_combination(1.0, linear_combination(c, vector, s, cross), along, axis)


def looked(camera: Camera, right: float, up: float) -> Camera:
    """The camera turned by degrees: to the right about the world's y axis, and up as far as straight up.

    There the horizontal part of the direction is some 1e-16: too little for any picture, and enough to keep the
    heading, so that the way back is the way that led there.
    """
    x, y, z = camera.direction
    (a, _, b), _ = upright(x, y, z)
    heading = atan2(-a, b) + radians(right) * handedness(camera)
    height = clamp(atan2(y, hypot(x, z)) + radians(up), -pi / 2, pi / 2)
    direction = cos(height) * cos(heading), sin(height), cos(height) * sin(heading)
    return camera.replace(direction=unit(direction))


def orbited(camera: Camera, pivot: Triple, right: float, up: float) -> Camera:
    """The camera turned like that, and moved so that `pivot` stays in the picture where it is."""
    turned_camera = looked(camera, right, up)
    place = pivot
    for old, new in zip(camera_frame(camera), camera_frame(turned_camera), strict=True):
        along = sum((at - middle) * part for at, middle, part in zip(camera.position, pivot, old, strict=True))
        place = linear_combination(1.0, place, along, new)
    return turned_camera.replace(position=limited(place))


def rolled(camera: Camera, degrees: float) -> Camera:
    """The camera turned about its direction, clockwise."""
    return camera.replace(roll=fmod(camera.roll + degrees * handedness(camera), 360.0))


def handedness(camera: Camera) -> float:
    """-1 where the picture is mirrored: what turns to the right or clockwise in it does the opposite in the scene."""
    return -1.0 if camera.left_handed else 1.0
