"""Perspective projection: convert between pixels of a picture and points of its scene."""

from __future__ import annotations

from math import hypot
from typing import NamedTuple

from minirt.fields import Triple, unit
from minirt.rendering.packing.camera import camera_numbers
from minirt.scene import Camera
from minirt.scene.camera_frame import linear_combination

Pixel = tuple[float, float]

MIN_DEPTH = 1e-9  # of the distance to the eye: points that are less far in front of the eye are on no picture
NEAR = 1e-3  # of the distance to the eye: depth at which a line is clipped
FAR = 1e3  # times that distance: length to which a line is drawn
PARALLEL = 1e-6  # square of the sine of the angle between a ray and an axis


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

    def point_at_depth(self, x: float, y: float, depth: float) -> Triple:
        """The point of the scene at this depth that projects to a point of the picture."""
        return linear_combination(1.0, self.eye, depth, self.direction_through(x, y))

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

    def visible_segment(self, point: Triple, axis: Triple) -> tuple[Pixel, Pixel] | None:
        """Project the line through `point` along the unit vector `axis`, clipped in front of the eye, to its two ends.

        None if all of the line is behind the eye.
        """
        distance = hypot(*subtract(point, self.eye))
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


def projection_of(camera: Camera, width: int, height: int) -> Projection:
    """Projection of a camera for a picture of this size."""
    eye, right, up, forward = (tuple(part) for part in camera_numbers(camera, width, height).reshape(4, 3).tolist())
    return Projection(eye, right, up, forward, width, height)


def dot(a: Triple, b: Triple) -> float:
    """Dot product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def subtract(a: Triple, b: Triple) -> Triple:
    """Difference a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]
