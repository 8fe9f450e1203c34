"""What is right and what is up for somebody who looks in a direction."""

from __future__ import annotations

from math import hypot

from minirt.fields.triples import Triple


def upright(x: float, y: float, z: float) -> tuple[Triple, Triple]:
    """Right and up, as unit vectors, of a picture whose middle lies along the unit vector x, y, z.

    Right is that vector x (0,1,0). Straight up and straight down, where this is zero, right is +x, which makes up +z
    and -z.
    """
    largest = max(abs(x), abs(z))
    if not largest:
        return (1.0, 0.0, 0.0), (0.0, 0.0, y)
    # The horizontal part is scaled first, so that not even 1e-300 of it loses its direction.
    a, b = x / largest, z / largest
    length = hypot(a, b)
    a, b = a / length, b / length
    return (-b, 0.0, a), (-a * y, hypot(x, z), -b * y)
