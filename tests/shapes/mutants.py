"""Wrong formulas that look right: the tests of the real ones must fail on them."""

from __future__ import annotations

from typing import Any

import numpy as np

from minirt.lanes import Vec, dot, fabs, sqrt
from minirt.shapes.plane import PackedPlane
from minirt.shapes.sphere import PackedSphere
from minirt.shapes.triangle import PackedTriangle, edge_function, permuted_axes, sheared
from tests.oracle.textbook import meets_cylinder, meets_sphere
from tests.shapes.execution_modes import on_arrays

naive_sphere = meets_sphere  # loses a small sphere far away
naive_cylinder = meets_cylinder  # has cracks at the rim, and fails along the axis


def first(r0: Any, r1: Any) -> Any:
    """The least root above 0, or the greater one if there is none."""
    near, far = np.minimum(r0, r1), np.maximum(r0, r1)
    return np.where(near > 0, near, far)


def accepts_nan(sphere: PackedSphere, origin: Vec, direction: Vec) -> Any:
    """A sphere's formula whose test for a hit is inverted, so that NaN is a hit."""
    f = origin - sphere.centre
    g = f - dot(f, direction) * direction
    chord = sphere.radius * sphere.radius - dot(g, g)
    return ~(chord < 0), first(-dot(f, direction) - sqrt(chord), -dot(f, direction) + sqrt(chord))


def naive_quadratic(a: Any, _: Any, b: Any, c: Any, _product: Any) -> Any:
    """`negative_interval` by the schoolbook formula, which cancels."""
    D = b * b - a * c
    return D >= 0, (-b - sqrt(D)) / a, (-b + sqrt(D)) / a


def hits_behind(plane: PackedPlane, origin: Vec, direction: Vec) -> Any:
    """A plane that is hit behind the eye, too."""
    slope = dot(plane.normal, direction)
    return slope != 0, fabs(dot(plane.normal, plane.point - origin) / slope)


def mean_of_corners(triangle: PackedTriangle, origin: Vec, direction: Vec) -> Any:
    """A triangle's formula whose distance is the mean of the corners, weighted by the edge functions: off the plane of
    a sliver by the square of its length over its height."""
    x, y, z = fabs(direction.x), fabs(direction.y), fabs(direction.z)
    by_x = (x >= y) & (x >= z)
    by_y = (y >= z) & ~by_x
    d = permuted_axes(by_x, by_y, direction)
    shear = Vec(d.x / d.z, d.y / d.z, 1.0 / d.z)
    corners = triangle.a, triangle.b, triangle.c
    a, b, c = (sheared(shear, permuted_axes(by_x, by_y, corner - origin)) for corner in corners)
    of_a, of_b, of_c = edge_function(b, c), edge_function(c, a), edge_function(a, b)
    inside = ((of_a >= 0) & (of_b >= 0) & (of_c >= 0)) | ((of_a <= 0) & (of_b <= 0) & (of_c <= 0))
    t = (of_a * a.z + of_b * b.z + of_c * c.z) / (of_a + of_b + of_c) / d.z
    return inside & (t > 0.0), t


def with_formula(formula: Any) -> Any:
    """`on_arrays` with another formula than the shape's own."""
    return lambda shapes, origins, directions: on_arrays(shapes, origins, directions, formula)
