"""The shapes. `KINDS` is the one list of those that are a formula each: a new one is a file beside these and a line
here. A mesh is many triangles."""

from minirt.shapes import (
    box,
    cone,
    cylinder,
    disc,
    hyperboloid,
    mesh,
    paraboloid,
    plane,
    sphere,
    square,
    torus,
    triangle,
)
from minirt.shapes.shape import Ball, Box, Kind, Shape

KINDS = (
    Kind(sphere.Sphere, sphere.PackedSphere, sphere.intersect, sphere.surface, sphere.mapping),
    Kind(plane.Plane, plane.PackedPlane, plane.intersect, plane.surface, plane.mapping),
    Kind(cylinder.Cylinder, cylinder.PackedCylinder, cylinder.intersect, cylinder.surface, cylinder.mapping),
    Kind(cone.Cone, cone.PackedCone, cone.intersect, cone.surface, cone.mapping),
    Kind(
        paraboloid.Paraboloid, paraboloid.PackedParaboloid, paraboloid.intersect, paraboloid.surface, paraboloid.mapping
    ),
    Kind(
        hyperboloid.Hyperboloid,
        hyperboloid.PackedHyperboloid,
        hyperboloid.intersect,
        hyperboloid.surface,
        hyperboloid.mapping,
    ),
    Kind(
        triangle.Triangle,
        triangle.PackedTriangle,
        triangle.intersect,
        triangle.surface,
        triangle.mapping,
        may_meet=triangle.may_meet,
    ),
    Kind(square.Square, square.PackedSquare, square.intersect, square.surface, square.mapping),
    Kind(disc.Disc, disc.PackedDisc, disc.intersect, disc.surface, disc.mapping),
    Kind(box.Box, box.PackedBox, box.intersect, box.surface, box.mapping),
    Kind(torus.Torus, torus.PackedTorus, torus.intersect, torus.surface, torus.mapping),
)
MESH = Kind(
    mesh.Mesh,
    mesh.PackedMeshTriangle,
    mesh.intersect,
    mesh.surface,
    mesh.mapping,
    mesh.shading,
    mesh.may_meet,
    batched=True,
)
ALL_KINDS = (*KINDS, MESH)

__all__ = ["ALL_KINDS", "KINDS", "MESH", "Ball", "Box", "Kind", "Shape"]
