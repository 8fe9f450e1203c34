"""Geometry of the view: pixels and points of the scene, and sizes of elements and scenes."""

from __future__ import annotations

from collections.abc import Sequence
from math import dist, hypot, inf
from statistics import median
from typing import Any, NamedTuple

from minirt.element import Element, fields_of
from minirt.fields import Point, Triple, clamp_length, unit
from minirt.rendering.packing.camera import camera_numbers
from minirt.scene import Camera, Scene
from minirt.scene.elements import linear_combination
from minirt.shapes import Shape

Pixel = tuple[float, float]

MIN_DEPTH = 1e-9  # of the distance to the eye: points that are less far in front of the eye are on no picture
PARALLEL = 1e-6  # square of the sine of the angle between a ray and an axis
Extent = tuple[Triple, float]  # centre and radius
UP: Triple = (0.0, 1.0, 0.0)
FLAT = 0.02  # slope of a view that is too level to show where it meets the ground
UNKNOWN_SIZE = 10.0  # scene units: the size of a scene that says nothing of it
SAMPLE_SIZE = 4096  # elements, evenly spaced in the file; their median is within some per cent of that of a million
STEP_SHARE = 1 / 40  # one step of a movement as a share of the scene's size, before rounding


class Projection(NamedTuple):
    """Perspective projection of a camera and picture size. Pixel x, y has its centre at x + 0.5, y + 0.5."""

    eye: Triple
    right: Triple  # right and up reach from the centre of the image plane at distance 1 to its edges
    up: Triple
    forward: Triple
    width: int
    height: int

    def direction_through(self, x: float, y: float) -> Triple:
        """Vector from the eye through a point of the picture; its component along `forward` is 1."""
        across, down = 2 * x / self.width - 1, 1 - 2 * y / self.height
        return linear_combination(1.0, linear_combination(across, self.right, down, self.up), 1.0, self.forward)

    def ray(self, x: float, y: float) -> Triple:
        """Unit direction of the ray from the eye through a point of the picture."""
        return unit(self.direction_through(x, y))

    def depth(self, point: Triple) -> float:
        """Depth of a point: its distance from the eye along `forward`, negative behind the eye."""
        return dot(subtract(point, self.eye), self.forward)

    def pixel(self, point: Triple) -> Pixel | None:
        """Project a point of the scene, also to outside the picture. None if it is not in front of the eye."""
        offset = subtract(point, self.eye)
        depth = dot(offset, self.forward)
        if depth <= MIN_DEPTH * hypot(*offset):
            return None
        across = dot(offset, self.right) / (depth * dot(self.right, self.right))
        down = dot(offset, self.up) / (depth * dot(self.up, self.up))
        return (1 + across) * self.width / 2, (1 - down) * self.height / 2

    def distance_along(self, x: float, y: float, point: Triple, axis: Triple) -> float | None:
        """Distance from `point` along the unit vector `axis` to where the line is nearest to the ray through x, y.

        None if line and ray are almost parallel.
        """
        ray, offset = self.ray(x, y), subtract(point, self.eye)
        slant = dot(ray, axis)
        across = 1 - slant * slant
        return (slant * dot(offset, ray) - dot(offset, axis)) / across if across > PARALLEL else None


def projection_of(camera: Camera, width: int, height: int) -> Projection:
    """Projection of a camera for a picture of this size."""
    eye, right, up, forward = (tuple(part) for part in camera_numbers(camera, width, height).reshape(4, 3).tolist())
    return Projection(eye, right, up, forward, width, height)


def dot(a: Triple, b: Triple) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def subtract(a: Triple, b: Triple) -> Triple:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def extent(element: Element) -> Extent | None:
    """Centre and radius of an element: half the longest side of its box, or 0 at its point; None for a camera."""
    box = element.bounds() if isinstance(element, Shape) else None
    if box is not None:
        (a, b, c), (x, y, z) = box
        return ((a + x) / 2, (b + y) / 2, (c + z) / 2), max(x - a, y - b, z - c) / 2
    point = None if isinstance(element, Camera) else position_of(element)
    return (point, 0.0) if point else None


def field_names(kind: type[Element], field_type: type[Any]) -> tuple[str, ...]:
    """Names of the fields of a type, such as the points or the directions."""
    return tuple(each.name for each in fields_of(kind) if isinstance(each, field_type))


def position_of(element: Element) -> Triple | None:
    """Position of an element: its first point, None if it has no points."""
    names = field_names(type(element), Point)
    position: Triple | None = getattr(element, names[0]) if names else None
    return position


def extents(scene: Scene) -> list[Extent]:
    """Extents of the bounded shapes of a scene or, if there are none, of all elements with a position."""

    def sampled(elements: Sequence[Element]) -> Sequence[Element]:
        return elements[:: max(1, -(-len(elements) // SAMPLE_SIZE))]

    bounded = [each for each in sampled(scene.shapes) if isinstance(each, Shape) and each.bounds() is not None]
    return list(filter(None, map(extent, bounded or sampled(scene.elements))))


def scene_size(scene: Scene) -> float:
    """Size of a scene: the median distance of its elements from the camera.

    The median ignores single distant or huge elements (a sky, a sun). Without elements it is the distance to what the
    camera looks at.
    """
    distances = [max(dist(scene.camera.position, centre), radius) for centre, radius in extents(scene)]
    apart = [distance for distance in distances if distance > 0]
    return clamp_length(median(apart) if apart else looked_at_distance(scene.camera))


def looked_at_distance(camera: Camera) -> float:
    """Distance from the camera to where it looks: to the ground y = 0, or to the point of its view nearest the origin.

    A camera in the origin, or one that looks away from it, tells less: the distance to the origin, or UNKNOWN_SIZE.
    """
    x, y, z = camera.position
    a, b, c = camera.direction
    if y * b < 0 and abs(b) > FLAT:
        return -y / b
    ahead, away = -(x * a + y * b + z * c), hypot(x, y, z)
    return ahead if ahead > away / 2 else away or UNKNOWN_SIZE


def scene_centre(scene: Scene) -> Triple:
    """Centre of a scene: the median of each coordinate, which ignores single distant elements."""
    centres = [centre for centre, _ in extents(scene)]
    if not centres:
        return 0.0, 0.0, 0.0
    x, y, z = (median(each) for each in zip(*centres, strict=True))
    return x, y, z


class Aim(NamedTuple):
    """The place where the line of sight through a pixel ends."""

    eye: Triple
    point: Triple
    normal: Triple | None  # of the surface there, towards the eye; None in the air
    size: float  # of an element there: it fills SHARE of the picture, and is a share of what it stands on
    usual: float = inf  # size of an element there that stands on nothing
    beneath: Shape | None = None  # the bounded shape whose top the place is on
