"""Textbook intersection formulas, to compare the formulas of `minirt.shapes` with.

They are right on paper. In floating point they lose shapes that are small and far away, hits at edges and rays that are
nearly parallel. Box, square and disc are not here, as `minirt.shapes` uses the textbook formulas for them; nor is the
torus, whose quartic textbooks leave to a library.
"""

from __future__ import annotations

from math import inf
from typing import Any

from minirt.lanes import Mask, Number, Vec, any, dot, fabs, minimum, splat, sqrt, where
from minirt.shapes.cone import PackedCone
from minirt.shapes.cylinder import PackedCylinder
from minirt.shapes.frames import to_basis
from minirt.shapes.hyperboloid import PackedHyperboloid
from minirt.shapes.paraboloid import PackedParaboloid
from minirt.shapes.plane import PackedPlane
from minirt.shapes.sphere import PackedSphere
from minirt.shapes.triangle import PackedTriangle, edge_function, permuted_axes, sheared
from tests.shapes.execution_modes import on_arrays

EPSILON = 1e-6  # textbooks take smaller numbers for zero


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


def meets_cone(cone: PackedCone, origin: Vec, direction: Vec) -> tuple[Mask, Number]:
    """|p x axis| = slope (p . axis) from the apex to the base, and the base."""
    p = to_basis(cone.u, cone.v, cone.w, origin - cone.apex)
    d = to_basis(cone.u, cone.v, cone.w, direction)
    square = cone.slope * cone.slope
    a = d.x * d.x + d.y * d.y - square * d.z * d.z
    b = p.x * d.x + p.y * d.y - square * p.z * d.z
    c = p.x * p.x + p.y * p.y - square * p.z * p.z
    best = sides(p, d, a, b, c, 0.0, cone.height)
    best = nearer(on_cap(p, d, cone.height, square * cone.height * cone.height), best)
    return best < inf, best


def meets_paraboloid(paraboloid: PackedParaboloid, origin: Vec, direction: Vec) -> tuple[Mask, Number]:
    """|p x axis|^2 = 2 focal (p . axis) below the rim, and the cap."""
    p = to_basis(paraboloid.u, paraboloid.v, paraboloid.w, origin - paraboloid.vertex)
    d = to_basis(paraboloid.u, paraboloid.v, paraboloid.w, direction)
    b = p.x * d.x + p.y * d.y - paraboloid.focal * d.z
    c = p.x * p.x + p.y * p.y - 2.0 * paraboloid.focal * p.z
    best = sides(p, d, d.x * d.x + d.y * d.y, b, c, 0.0, paraboloid.height)
    best = nearer(on_cap(p, d, paraboloid.height, 2.0 * paraboloid.focal * paraboloid.height), best)
    return best < inf, best


def meets_hyperboloid(hyperboloid: PackedHyperboloid, origin: Vec, direction: Vec) -> tuple[Mask, Number]:
    """|p x axis|^2 = waist^2 + slope^2 (p . axis)^2 between the caps, and the caps."""
    p = to_basis(hyperboloid.u, hyperboloid.v, hyperboloid.w, origin - hyperboloid.centre)
    d = to_basis(hyperboloid.u, hyperboloid.v, hyperboloid.w, direction)
    square, slope = hyperboloid.waist * hyperboloid.waist, hyperboloid.slope * hyperboloid.slope
    a = d.x * d.x + d.y * d.y - slope * d.z * d.z
    b = p.x * d.x + p.y * d.y - slope * p.z * d.z
    c = p.x * p.x + p.y * p.y - square - slope * p.z * p.z
    end = square + slope * hyperboloid.half * hyperboloid.half
    best = sides(p, d, a, b, c, -hyperboloid.half, hyperboloid.half)
    best = nearer(on_cap(p, d, -hyperboloid.half, end), best)
    best = nearer(on_cap(p, d, hyperboloid.half, end), best)
    return best < inf, best


def sides(p: Vec, d: Vec, a: Number, b: Number, c: Number, low: Number, high: Number) -> Number:
    """Return the least positive root of a t^2 + 2 b t + c = 0 between two heights, or infinity."""
    D = b * b - a * c
    best = splat(inf, D)
    if any(D >= 0.0):
        root = sqrt(D)
        best = nearer(on_side(p, d, (-b - root) / a, low, high), best)
        best = nearer(on_side(p, d, (-b + root) / a, low, high), best)
    return best


def on_side(p: Vec, d: Vec, t: Number, low: Number, high: Number) -> tuple[Mask, Number]:
    """Test whether the point at t lies between two heights."""
    height = p.z + t * d.z
    return (t > 0.0) & (height >= low) & (height <= high), t


def on_cap(p: Vec, d: Vec, height: Number, square: Number) -> tuple[Mask, Number]:
    """Intersect the plane at a height, within a radius given by its square."""
    t = (height - p.z) / d.z
    x, y = p.x + t * d.x, p.y + t * d.y
    return (t > 0.0) & (x * x + y * y <= square), t


def nearer(found: tuple[Mask, Number], best: Number) -> Number:
    """Return the lesser of the best distance and a hit."""
    hit, t = found
    return where(hit, minimum(t, best), best)


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
