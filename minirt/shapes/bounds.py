"""Boxes and places, for what surrounds a shape."""

from __future__ import annotations

from math import hypot

from minirt.fields import Triple
from minirt.shapes.shape import Bounds


def point_along(point: Triple, axis: Triple, distance: float) -> Triple:
    """The point at a distance along the unit vector `axis`."""
    (x, y, z), (u, v, w) = point, axis
    return x + distance * u, y + distance * v, z + distance * w


def disc_extents(axis: Triple) -> Triple:
    """How far a disc of radius 1 whose axis is a unit vector reaches along x, y and z.

    That is sqrt(1 - w^2) for a component w of the axis, where 1 is the sum of the squares of all three.
    """
    u, v, w = axis
    return hypot(v, w), hypot(w, u), hypot(u, v)


def bounds_of_disc(centre: Triple, axis: Triple, radius: float) -> Bounds:
    """The box around a disc."""
    (x, y, z), (i, j, k) = centre, (radius * reach for reach in disc_extents(axis))
    return (x - i, y - j, z - k), (x + i, y + j, z + k)


def bounds_of_points(*points: Triple) -> Bounds:
    """The box around some points."""
    xs, ys, zs = zip(*points, strict=True)
    return (min(xs), min(ys), min(zs)), (max(xs), max(ys), max(zs))


def union_of_bounds(*boxes: Bounds) -> Bounds:
    """The box around some boxes."""
    return bounds_of_points(*(corner for box in boxes for corner in box))
