"""The shapes. `KINDS` is the one list of them: a new shape is a file beside these and a line here."""

from minirt.shapes import cone, cylinder, hyperboloid, paraboloid, plane, sphere
from minirt.shapes.shape import Ball, Box, Kind, Shape

KINDS = (
    Kind(sphere.Sphere, sphere.PackedSphere, sphere.intersect, sphere.surface),
    Kind(plane.Plane, plane.PackedPlane, plane.intersect, plane.surface),
    Kind(cylinder.Cylinder, cylinder.PackedCylinder, cylinder.intersect, cylinder.surface),
    Kind(cone.Cone, cone.PackedCone, cone.intersect, cone.surface),
    Kind(paraboloid.Paraboloid, paraboloid.PackedParaboloid, paraboloid.intersect, paraboloid.surface),
    Kind(hyperboloid.Hyperboloid, hyperboloid.PackedHyperboloid, hyperboloid.intersect, hyperboloid.surface),
)

__all__ = ["KINDS", "Ball", "Box", "Kind", "Shape"]
