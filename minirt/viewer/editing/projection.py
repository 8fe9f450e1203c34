"""Between pixels of a picture and places in its scene."""

from __future__ import annotations

from math import hypot
from typing import NamedTuple

from minirt.fields import Triple, unit
from minirt.rendering.packing.camera import camera_numbers
from minirt.scene import Camera
from minirt.scene.camera_frame import linear_combination

Pixel = tuple[float, float]

BESIDE = 1e-9  # of the distance to the eye: what is less in front of it than that is on no picture
NEAR = 1e-3  # of the distance to the eye: how near to its plane a line is drawn
FAR = 1e3  # times that distance: how far a line is drawn
PARALLEL = 1e-6  # square of the sine of the angle between a ray and an axis


class Projection(NamedTuple):
    """A camera and the size of its picture. Pixel x, y has its middle at x + 0.5, y + 0.5."""

    eye: Triple
    right: Triple  # right and up reach from the middle of a picture at distance 1 to its edges
    up: Triple
    forward: Triple
    width: int
    height: int

    def towards(self, x: float, y: float) -> Triple:
        """What leads from the eye through a point of the picture; its part along `forward` has length 1."""
        across, down = 2 * x / self.width - 1, 1 - 2 * y / self.height
        return linear_combination(1.0, linear_combination(across, self.right, down, self.up), 1.0, self.forward)

    def ray(self, x: float, y: float) -> Triple:
        """The same at length 1."""
        return unit(self.towards(x, y))

    def depth(self, point: Triple) -> float:
        """How far in front of the eye a place is, along `forward`; negative behind it."""
        return dot(minus(point, self.eye), self.forward)

    def at_depth(self, x: float, y: float, depth: float) -> Triple:
        """The place that is so far in front of the eye and shows at a point of the picture."""
        return linear_combination(1.0, self.eye, depth, self.towards(x, y))

    def pixel(self, point: Triple) -> Pixel | None:
        """Where in the picture, or beside it, a place shows; None where it is not in front of the eye."""
        way = minus(point, self.eye)
        depth = dot(way, self.forward)
        if depth <= BESIDE * hypot(*way):
            return None
        across = dot(way, self.right) / (depth * dot(self.right, self.right))
        down = dot(way, self.up) / (depth * dot(self.up, self.up))
        return (1 + across) * self.width / 2, (1 - down) * self.height / 2

    def along(self, x: float, y: float, point: Triple, axis: Triple) -> float | None:
        """How far from `point` along the unit vector `axis` the place is that comes nearest to a point of the picture.

        The place of the axis nearest to the ray; None where the two are all but parallel.
        """
        ray, way = self.ray(x, y), minus(point, self.eye)
        slant = dot(ray, axis)
        across = 1 - slant * slant
        return (slant * dot(way, ray) - dot(way, axis)) / across if across > PARALLEL else None

    def segment(self, point: Triple, axis: Triple) -> tuple[Pixel, Pixel] | None:
        """Two points of the picture between which the line through `point` along the unit vector `axis` shows; None
        where all of it is behind the eye."""
        distance = hypot(*minus(point, self.eye))
        depth, slope, near = self.depth(point), dot(axis, self.forward), NEAR * distance
        low, high = -FAR * distance, FAR * distance
        if slope > 0:
            low = max(low, (near - depth) / slope)
        elif slope < 0:
            high = min(high, (near - depth) / slope)
        elif depth < near:
            return None
        start, end = (self.pixel(linear_combination(1.0, point, reach, axis)) for reach in (low, high))
        return (start, end) if low < high and start and end else None


def projection(camera: Camera, width: int, height: int) -> Projection:
    """The lens of a camera."""
    eye, right, up, forward = (tuple(part) for part in camera_numbers(camera, width, height).reshape(4, 3).tolist())
    return Projection(eye, right, up, forward, width, height)


def dot(a: Triple, b: Triple) -> float:
    """The scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def minus(a: Triple, b: Triple) -> Triple:
    """a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]
