"""Where a camera's picture lies in space."""

from __future__ import annotations

from math import cos, hypot, radians, sin

from minirt.fields import Triple
from minirt.scene.elements import Camera


def view(camera: Camera) -> tuple[Triple, Triple, Triple]:
    """Unit vectors right, up and forward of the picture, perpendicular to each other.

    `right` is forward x (0,1,0). Straight up and straight down, where that is zero, right is +x, which makes up +z and
    -z. A roll then turns right and up about forward, clockwise as the camera sees it. In the mirrored picture of a
    left-handed camera right is the opposite of all that.
    """
    x, y, z = camera.direction
    right, up = upright(x, y, z)
    if camera.roll:
        c, s = cos(radians(camera.roll)), sin(radians(camera.roll))
        right, up = mix(c, right, -s, up), mix(s, right, c, up)
    if camera.left_handed:
        right = mix(-1.0, right, 0.0, right)
    return right, up, (x, y, z)


def upright(x: float, y: float, z: float) -> tuple[Triple, Triple]:
    """Right and up of a camera without roll that looks along the unit vector x, y, z."""
    largest = max(abs(x), abs(z))
    if not largest:
        return (1.0, 0.0, 0.0), (0.0, 0.0, y)
    # The horizontal part is scaled first, so that not even 1e-300 of it loses its direction.
    a, b = x / largest, z / largest
    length = hypot(a, b)
    a, b = a / length, b / length
    return (-b, 0.0, a), (-a * y, hypot(x, z), -b * y)


def mix(a: float, u: Triple, b: float, v: Triple) -> Triple:
    """a u + b v."""
    return a * u[0] + b * v[0], a * u[1] + b * v[1], a * u[2] + b * v[2]
