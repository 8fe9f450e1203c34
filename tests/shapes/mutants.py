"""Formulas that look right and are not: the tests of the real ones must fail on them."""

from __future__ import annotations

from typing import Any

import numpy as np

from minirt.lanes import Vec, dot, fabs, minimum, sqrt, where
from minirt.shapes.basis import to_basis
from minirt.shapes.cylinder import PackedCylinder
from minirt.shapes.plane import PackedPlane
from minirt.shapes.sphere import PackedSphere
from tests.shapes.ways import on_arrays


def first(r0: Any, r1: Any) -> Any:
    """The least root above 0, or else the other."""
    near, far = np.minimum(r0, r1), np.maximum(r0, r1)
    return np.where(near > 0, near, far)


def from_the_origin(sphere: PackedSphere, origin: Vec, direction: Vec) -> Any:
    """The schoolbook quadratic, which loses a small sphere that is far away."""
    f = origin - sphere.centre
    b, c = dot(f, direction), dot(f, f) - sphere.radius * sphere.radius
    D = b * b - c
    t = first(-b - sqrt(D), -b + sqrt(D))
    return (D >= 0) & (t > 0), t


def accepts_nan(sphere: PackedSphere, origin: Vec, direction: Vec) -> Any:
    """The sphere's formula with its test turned round."""
    f = origin - sphere.centre
    g = f - dot(f, direction) * direction
    chord = sphere.radius * sphere.radius - dot(g, g)
    return ~(chord < 0), first(-dot(f, direction) - sqrt(chord), -dot(f, direction) + sqrt(chord))


def piece_by_piece(cylinder: PackedCylinder, origin: Vec, direction: Vec) -> Any:
    """Side and caps one after the other, from the origin: cracks at the rim, and no way along the axis."""
    p = to_basis(cylinder.u, cylinder.v, cylinder.w, origin - cylinder.centre)
    d = to_basis(cylinder.u, cylinder.v, cylinder.w, direction)
    a, b = d.x * d.x + d.y * d.y, p.x * d.x + p.y * d.y
    c = p.x * p.x + p.y * p.y - cylinder.radius * cylinder.radius
    root = sqrt(b * b - a * c)
    best = np.inf
    for t in ((-b - root) / a, (-b + root) / a):
        best = where((t > 0) & (fabs(p.z + t * d.z) <= cylinder.half), minimum(t, best), best)
    for cap in (-cylinder.half, cylinder.half):
        t = (cap - p.z) / d.z
        x, y = p.x + t * d.x, p.y + t * d.y
        inside = x * x + y * y <= cylinder.radius * cylinder.radius
        best = where((t > 0) & inside, minimum(t, best), best)
    return best < np.inf, best


def no_sign(a: Any, b: Any, c: Any) -> Any:
    """`below_zero` without its copysign."""
    D = b * b - a * c
    q = -(b + sqrt(D))
    return D >= 0, np.minimum(q / a, c / q), np.maximum(q / a, c / q)


def two_roots(a: Any, b: Any, c: Any) -> Any:
    """`below_zero` by the formula of school."""
    D = b * b - a * c
    return D >= 0, (-b - sqrt(D)) / a, (-b + sqrt(D)) / a


def hits_behind(plane: PackedPlane, origin: Vec, direction: Vec) -> Any:
    """A plane that is hit behind the eye too."""
    slope = dot(plane.normal, direction)
    return slope != 0, fabs(dot(plane.normal, plane.point - origin) / slope)


def way(formula: Any) -> Any:
    """`on_arrays` with another formula."""
    return lambda shapes, origins, directions: on_arrays(shapes, origins, directions, formula)
