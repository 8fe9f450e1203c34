"""Formulas of a triangle of a mesh, which has a normal and texture coordinates at each corner."""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.lanes import Number, Vec, any, copysign, cross, dot, max_norm, maximum, minimum, unit, where
from minirt.shapes import triangle
from minirt.shapes.boundary import Boundary, facing
from minirt.shapes.shape import Position

BARYCENTRIC = (0.0, 0.0, 1.0, 0.0, 0.0, 1.0)  # u and v at the three corners where the file has none
OPPOSED = 1e-3  # squared length of a mean of unit normals; below it they cancel, and the mean points anywhere


class PackedMeshTriangle(NamedTuple):
    """Packed form of one triangle of a mesh."""

    a: Position
    b: Position
    c: Position
    normal: Vec
    normal_a: Vec  # shading normals at the corners
    normal_b: Vec
    normal_c: Vec
    u_a: float  # texture coordinates at the corners
    v_a: float
    u_b: float
    v_b: float
    u_c: float
    v_c: float


intersect, surface, may_meet = triangle.intersect, triangle.surface, triangle.may_meet


def barycentric_coordinates(mesh: PackedMeshTriangle, point: Vec) -> tuple[Number, Number, Number]:
    """Barycentric coordinates of a point of the triangle, clamped to [0, 1]."""
    ab, ac, ap = mesh.b - mesh.a, mesh.c - mesh.a, point - mesh.a
    whole = dot(cross(ab, ac), mesh.normal)  # twice the area
    of_b = minimum(maximum(dot(cross(ap, ac), mesh.normal) / whole, 0.0), 1.0)
    of_c = minimum(maximum(dot(cross(ab, ap), mesh.normal) / whole, 0.0), 1.0 - of_b)
    return 1.0 - of_b - of_c, of_b, of_c


def shading(mesh: PackedMeshTriangle, point: Vec, normal: Vec) -> Vec:
    """Interpolate the normals of the corners (Phong, Illumination for Computer Generated Pictures, 1975).

    Where they cancel, or all are 0 or that of the triangle, its own `normal` is used.
    """
    uneven = max_norm(mesh.normal_b - mesh.normal_a) + max_norm(mesh.normal_c - mesh.normal_a)
    if not any(uneven + max_norm(mesh.normal_a) * max_norm(mesh.normal_a - mesh.normal) > 0.0):
        return normal
    of_a, of_b, of_c = barycentric_coordinates(mesh, point)
    mean = of_a * mesh.normal_a + of_b * mesh.normal_b + of_c * mesh.normal_c
    return unit(where(dot(mean, mean) > OPPOSED, mean, normal))


def smooth_point(mesh: PackedMeshTriangle, point: Vec, normal: Vec) -> Vec:
    """Return a point of the triangle, moved onto the smooth surface that the normals at its corners suggest.

    At each corner its normal defines a tangent plane. The point is projected onto each of those that it lies below, and
    the mean of the projections is weighted by the barycentric coordinates (Hanika, Hacking the Shadow Terminator, Ray
    Tracing Gems II, 2021, chapter 4). With the normals of a sphere it lies as far above the sphere as the triangle lies
    below. "Below" is as seen from the side of the unit vector `normal`.
    """
    of_a, of_b, of_c = barycentric_coordinates(mesh, point)
    side = copysign(1.0, dot(mesh.normal, normal))
    to_a = of_a * minimum(side * dot(point - mesh.a, mesh.normal_a), 0.0)
    to_b = of_b * minimum(side * dot(point - mesh.b, mesh.normal_b), 0.0)
    to_c = of_c * minimum(side * dot(point - mesh.c, mesh.normal_c), 0.0)
    return point - side * (to_a * mesh.normal_a + to_b * mesh.normal_b + to_c * mesh.normal_c)


def mapping(mesh: PackedMeshTriangle, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """Return u and v, those of the file or one picture a triangle as on `tr`, and tangents perpendicular to `normal`.

    The tangents are 0 where the triangle has no area in the picture. `normal` is the interpolated one, so that bumps
    rise from the smooth surface.
    """
    of_a, of_b, of_c = barycentric_coordinates(mesh, point)
    ab, ac = mesh.b - mesh.a, mesh.c - mesh.a
    u_b, v_b, u_c, v_c = mesh.u_b - mesh.u_a, mesh.v_b - mesh.v_a, mesh.u_c - mesh.u_a, mesh.v_c - mesh.v_a
    area = u_b * v_c - u_c * v_b  # twice the area of the triangle in the picture
    per_area = where(area == 0.0, 0.0, 1.0 / where(area == 0.0, 1.0, area))
    along_u, along_v = per_area * (v_c * ab - v_b * ac), per_area * (u_b * ac - u_c * ab)
    return (
        of_a * mesh.u_a + of_b * mesh.u_b + of_c * mesh.u_c,
        of_a * mesh.v_a + of_b * mesh.v_b + of_c * mesh.v_c,
        along_u - dot(along_u, normal) * normal,
        along_v - dot(along_v, normal) * normal,
    )


def boundary(mesh: Any, point: Vec) -> Boundary:
    """As for `tr`, of a triangle with rounded corners; its normal is on the side of the normals of the file."""
    flat = triangle.boundary(mesh, point)
    return Boundary((facing(mesh.normal, flat.faces[0]),), flat.limits)
