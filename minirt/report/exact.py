"""Where a ray meets a shape, to 60 digits, in the decimal arithmetic of the standard library.

The numbers of scene, ray and shape are taken as they are, to the last bit; only axes and normals, which a scene means
to have unit length, are scaled to it. Every solid here is convex: a ray is in it for one interval of t, or for none.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from decimal import Context, Decimal, localcontext
from typing import Any

from minirt.shapes import Shape
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere

Exact = list[Decimal]  # a vector
Interval = tuple[Decimal, Decimal] | None
DIGITS = Context(prec=60)
END = Decimal("Infinity")


def distance(shape: Shape, origin: Sequence[float], direction: Sequence[float], swell: float = 0.0) -> Decimal:
    """The least t > 0 at which origin + t direction lies on the surface, or infinity.

    The surface of a solid is moved outwards by `swell`: what a formula in fewer digits may answer lies between the
    answers for a solid a little larger and one a little smaller. KeyError for a shape that there is no formula for.
    """
    with localcontext(DIGITS):
        inside = INSIDE[type(shape)](shape, exact(origin), exact(direction), Decimal(swell))
        return min((t for t in inside or () if t > 0), default=END)


def in_plane(plane: Any, origin: Exact, direction: Exact, _: Decimal) -> Interval:
    """Where a line is in a plane: a single point of it, but for one along the plane."""
    normal = exact(plane.normal)
    slope = dot(normal, direction)
    t = dot(normal, minus(exact(plane.point), origin)) / slope if slope else END
    return (t, t) if slope else None


def in_sphere(sphere: Any, origin: Exact, direction: Exact, swell: Decimal) -> Interval:
    """Where a line is in a ball."""
    return near_zero(minus(origin, exact(sphere.centre)), direction, Decimal(sphere.diameter) / 2 + swell)


def in_cylinder(cylinder: Any, origin: Exact, direction: Exact, swell: Decimal) -> Interval:
    """Where a line is in the endless tube and between the planes of the caps."""
    axis = unit(exact(cylinder.axis))
    out = minus(origin, exact(cylinder.centre))
    height, climb = dot(out, axis), dot(direction, axis)
    half = Decimal(cylinder.height) / 2 + swell
    tube = near_zero(across(out, axis), across(direction, axis), Decimal(cylinder.diameter) / 2 + swell)
    return both(tube, between(height, climb, half))


INSIDE: dict[type[Shape], Callable[..., Interval]] = {Plane: in_plane, Sphere: in_sphere, Cylinder: in_cylinder}


def near_zero(p: Exact, d: Exact, radius: Decimal) -> Interval:
    """Where |p + t d| <= radius."""
    a, b, c = dot(d, d), dot(p, d), dot(p, p) - radius * radius
    if radius < 0 or (a == 0 and c > 0):
        return None
    if a == 0:
        return -END, END
    square = b * b - a * c
    return ((-b - square.sqrt()) / a, (-b + square.sqrt()) / a) if square >= 0 else None


def between(height: Decimal, climb: Decimal, half: Decimal) -> Interval:
    """Where |height + t climb| <= half."""
    if climb == 0:
        return (-END, END) if abs(height) <= half else None
    ends = (-half - height) / climb, (half - height) / climb
    return (min(ends), max(ends)) if half >= 0 else None


def both(a: Interval, b: Interval) -> Interval:
    """What two intervals have in common."""
    if a is None or b is None:
        return None
    start, end = max(a[0], b[0]), min(a[1], b[1])
    return (start, end) if start <= end else None


def exact(numbers: Sequence[float]) -> Exact:
    """Numbers as they are, to the last bit."""
    return [Decimal(float(number)) for number in numbers]


def dot(a: Exact, b: Exact) -> Decimal:
    """The scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def minus(a: Exact, b: Exact) -> Exact:
    """a - b."""
    return [x - y for x, y in zip(a, b, strict=True)]


def unit(v: Exact) -> Exact:
    """v, scaled to length 1."""
    length = dot(v, v).sqrt()
    return [x / length for x in v]


def across(v: Exact, axis: Exact) -> Exact:
    """The part of v that is perpendicular to the unit vector `axis`."""
    along = dot(v, axis)
    return [x - along * y for x, y in zip(v, axis, strict=True)]
