"""Camera frame: the basis of a camera's picture in world space."""

from __future__ import annotations

from math import cos, radians, sin

from minirt.fields import Triple, upright
from minirt.scene.elements import Camera


def camera_frame(camera: Camera) -> tuple[Triple, Triple, Triple]:
    """Return the orthonormal vectors right, up and forward of a camera.

    Without a roll the picture is upright. A roll turns right and up about forward, clockwise as the camera sees it.
    A left-handed camera mirrors its picture: right is negated.
    """
    x, y, z = camera.direction
    right, up = upright(x, y, z)
    if camera.roll:
        c, s = cos(radians(camera.roll)), sin(radians(camera.roll))
        right, up = linear_combination(c, right, -s, up), linear_combination(s, right, c, up)
    if camera.left_handed:
        right = linear_combination(-1.0, right, 0.0, right)
    return right, up, (x, y, z)


def linear_combination(a: float, u: Triple, b: float, v: Triple) -> Triple:
    """Return a u + b v."""
    return a * u[0] + b * v[0], a * u[1] + b * v[1], a * u[2] + b * v[2]
