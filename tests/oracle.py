"""Where a ray meets a shape, to 60 digits.

The numbers of scene, ray and shape are taken as they are, to the last bit; only the axes and normals, which a scene
means to have unit length, are scaled to it. The formulas are schoolbook ones: with so many digits nothing cancels.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import singledispatch

from mpmath import mp, mpf, sqrt

from minirt.shapes import Shape
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere

Exact = list[mpf]  # a vector

mp.dps = 60


def nearest(shape: Shape, origin: Sequence[float], direction: Sequence[float], swell: float = 0.0) -> mpf | None:
    """The least t > 0 at which origin + t direction lies on the surface, or None.

    The surface of a solid is moved outwards by `swell`: what a formula may answer lies between the answers for a solid
    a little larger and one a little smaller.
    """
    found = [t for t in crossings(shape, exact(origin), exact(direction), mpf(swell)) if t > 0]
    return min(found, default=None)


@singledispatch
def crossings(shape: Shape, origin: Exact, direction: Exact, swell: mpf) -> list[mpf]:
    """All t at which the line meets the surface."""
    raise TypeError(f"the oracle knows no {shape.title}")


@crossings.register
def _(plane: Plane, origin: Exact, direction: Exact, swell: mpf) -> list[mpf]:
    normal = exact(plane.normal)
    slope = dot(normal, direction)
    return [dot(normal, minus(exact(plane.point), origin)) / slope] if slope else []


@crossings.register
def _(sphere: Sphere, origin: Exact, direction: Exact, swell: mpf) -> list[mpf]:
    radius = mpf(sphere.diameter) / 2 + swell
    out = minus(origin, exact(sphere.centre))
    return roots(dot(direction, direction), 2 * dot(out, direction), dot(out, out) - radius**2)


@crossings.register
def _(cylinder: Cylinder, origin: Exact, direction: Exact, swell: mpf) -> list[mpf]:
    radius, half = mpf(cylinder.diameter) / 2 + swell, mpf(cylinder.height) / 2 + swell
    axis = unit(exact(cylinder.axis))
    out = minus(origin, exact(cylinder.centre))
    # The side: |out x axis + t direction x axis| = radius, between the caps.
    a, b = cross(out, axis), cross(direction, axis)
    height, climb = dot(out, axis), dot(direction, axis)
    found = [t for t in roots(dot(b, b), 2 * dot(a, b), dot(a, a) - radius**2) if abs(height + t * climb) <= half]
    # The caps: height + t climb = +-half, within the radius.
    for cap in (half, -half) if climb else ():
        t = (cap - height) / climb
        offset = [x + t * y for x, y in zip(a, b, strict=True)]
        if dot(offset, offset) <= radius**2:
            found.append(t)
    return found


def roots(a: mpf, b: mpf, c: mpf) -> list[mpf]:
    """The real solutions of a t^2 + b t + c = 0."""
    if a == 0:
        return [-c / b] if b else []
    square = b * b - 4 * a * c
    return [(-b - sqrt(square)) / (2 * a), (-b + sqrt(square)) / (2 * a)] if square >= 0 else []


def exact(numbers: Iterable[float]) -> Exact:
    return [mpf(float(number)) for number in numbers]


def unit(v: Exact) -> Exact:
    length = sqrt(dot(v, v))
    return [x / length for x in v]


def minus(a: Exact, b: Exact) -> Exact:
    return [x - y for x, y in zip(a, b, strict=True)]


def dot(a: Exact, b: Exact) -> mpf:
    return sum((x * y for x, y in zip(a, b, strict=True)), mpf(0))


def cross(a: Exact, b: Exact) -> Exact:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
