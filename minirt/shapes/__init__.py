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
    Kind(sphere.Sphere, sphere.PackedSphere, sphere.intersect, sphere.surface),
    Kind(plane.Plane, plane.PackedPlane, plane.intersect, plane.surface),
    Kind(cylinder.Cylinder, cylinder.PackedCylinder, cylinder.intersect, cylinder.surface),
    Kind(cone.Cone, cone.PackedCone, cone.intersect, cone.surface),
    Kind(paraboloid.Paraboloid, paraboloid.PackedParaboloid, paraboloid.intersect, paraboloid.surface),
    Kind(hyperboloid.Hyperboloid, hyperboloid.PackedHyperboloid, hyperboloid.intersect, hyperboloid.surface),
    Kind(triangle.Triangle, triangle.PackedTriangle, triangle.intersect, triangle.surface),
    Kind(square.Square, square.PackedSquare, square.intersect, square.surface),
    Kind(disc.Disc, disc.PackedDisc, disc.intersect, disc.surface),
    Kind(box.Box, box.PackedBox, box.intersect, box.surface),
    Kind(torus.Torus, torus.PackedTorus, torus.intersect, torus.surface),
)
MESH = Kind(mesh.Mesh, mesh.PackedMeshTriangle, mesh.intersect, mesh.surface, shading=mesh.shading)
ALL_KINDS = (*KINDS, MESH)

__all__ = ["ALL_KINDS", "KINDS", "MESH", "Ball", "Box", "Kind", "Shape"]
