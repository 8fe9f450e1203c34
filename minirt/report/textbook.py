"""The formulas that are in every textbook, to compare those of `minirt.shapes` with.

They are right on paper. With the digits that a computer has they lose what is small and far away, what lies at an edge
and what is nearly parallel.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

from minirt.lanes import Vec, any, dot, fabs, minimum, splat, sqrt, where
from minirt.lanes.vec import Number
from minirt.lanes.verbs import Mask
from minirt.shapes import Shape
from minirt.shapes.basis import to_basis
from minirt.shapes.cylinder import Cylinder, PackedCylinder
from minirt.shapes.plane import PackedPlane, Plane
from minirt.shapes.sphere import PackedSphere, Sphere

EPSILON = 1e-6  # what textbooks take for zero


def meets_sphere(sphere: PackedSphere, origin: Vec, direction: Vec) -> tuple[Mask, Number]:
    """The quadratic of |origin + t direction - centre| = radius."""
    f = origin - sphere.centre
    b = dot(f, direction)
    D = b * b - (dot(f, f) - sphere.radius * sphere.radius)
    hit = D >= 0.0
    t = b
    if any(hit):
        root = sqrt(D)
        near = -b - root
        t = where(near > 0.0, near, root - b)
    return hit & (t > 0.0), t


def meets_plane(plane: PackedPlane, origin: Vec, direction: Vec) -> tuple[Mask, Number]:
    """The plane's equation, unless the ray is nearly parallel."""
    slope = dot(plane.normal, direction)
    t = dot(plane.normal, plane.point - origin) / slope
    return (fabs(slope) > EPSILON) & (t > 0.0), t


def meets_cylinder(cylinder: PackedCylinder, origin: Vec, direction: Vec) -> tuple[Mask, Number]:
    """|p x axis|^2 = radius^2 between the caps, and the caps."""
    p = to_basis(cylinder.u, cylinder.v, cylinder.w, origin - cylinder.centre)
    d = to_basis(cylinder.u, cylinder.v, cylinder.w, direction)
    square = cylinder.radius * cylinder.radius
    c = p.x * p.x + p.y * p.y - square
    best = sides(p, d, d.x * d.x + d.y * d.y, p.x * d.x + p.y * d.y, c, -cylinder.half, cylinder.half)
    best = nearer(on_cap(p, d, -cylinder.half, square), best)
    best = nearer(on_cap(p, d, cylinder.half, square), best)
    return best < inf, best


def sides(p: Vec, d: Vec, a: Number, b: Number, c: Number, low: Number, high: Number) -> Number:
    """The distance to the nearest point of a t^2 + 2 b t + c = 0 between two heights, or infinity."""
    D = b * b - a * c
    best = splat(inf, D)
    if any(D >= 0.0):
        root = sqrt(D)
        best = nearer(on_side(p, d, (-b - root) / a, low, high), best)
        best = nearer(on_side(p, d, (-b + root) / a, low, high), best)
    return best


def on_side(p: Vec, d: Vec, t: Number, low: Number, high: Number) -> tuple[Mask, Number]:
    """Whether the point at t lies between two heights."""
    height = p.z + t * d.z
    return (t > 0.0) & (height >= low) & (height <= high), t


def on_cap(p: Vec, d: Vec, height: Number, square: Number) -> tuple[Mask, Number]:
    """Whether and where the plane at a height is hit within a radius, of which this is the square."""
    t = (height - p.z) / d.z
    x, y = p.x + t * d.x, p.y + t * d.y
    return (t > 0.0) & (x * x + y * y <= square), t


def nearer(found: tuple[Mask, Number], best: Number) -> Number:
    """The lesser distance, where there is another one."""
    hit, t = found
    return where(hit, minimum(t, best), best)


FORMULAS: dict[type[Shape], Callable[..., Any]] = {
    Sphere: meets_sphere,
    Plane: meets_plane,
    Cylinder: meets_cylinder,
}
