"""Right and up vectors of a view direction, and cosines and sines of angles in degrees."""

from __future__ import annotations

from math import cos, hypot, radians, sin

from minirt.fields.triples import Triple


def upright(x: float, y: float, z: float) -> tuple[Triple, Triple]:
    """Right and up, as unit vectors, for a view along the unit vector x, y, z.

    Right is the cross product of that vector and (0,1,0). For a view straight up or down, where this is zero, right is
    +x, and up is +z or -z.
    """
    largest = max(abs(x), abs(z))
    if not largest:
        return (1.0, 0.0, 0.0), (0.0, 0.0, y)
    # Scale the horizontal part first, so that its direction is kept even if its length is 1e-300.
    a, b = x / largest, z / largest
    length = hypot(a, b)
    a, b = a / length, b / length
    return (-b, 0.0, a), (-a * y, hypot(x, z), -b * y)


def cos_and_sin(degrees: float) -> tuple[float, float]:
    """Cosine and sine of an angle; exact for multiples of a right angle."""
    quarters = round(degrees / 90)
    rest = radians(degrees - 90 * quarters)
    c, s = cos(rest), sin(rest)
    return ((c, s), (-s, c), (-c, -s), (s, -c))[quarters % 4]
