"""Axis-aligned bounding boxes of discs, points and other boxes."""

from __future__ import annotations

from math import hypot

from minirt.fields import Triple
from minirt.shapes.shape import Bounds


def point_along(point: Triple, axis: Triple, distance: float) -> Triple:
    """The point at a distance from `point` along the unit vector `axis`."""
    (x, y, z), (u, v, w) = point, axis
    return x + distance * u, y + distance * v, z + distance * w


def disc_extents(axis: Triple) -> Triple:
    """Half extents along x, y and z of a disc of radius 1 about a unit axis.

    For a component w of the axis the extent is sqrt(1 - w^2), here the root of the sum of the other two squares.
    """
    u, v, w = axis
    return hypot(v, w), hypot(w, u), hypot(u, v)


def bounds_of_disc(centre: Triple, axis: Triple, radius: float) -> Bounds:
    """The bounding box of a disc."""
    (x, y, z), (i, j, k) = centre, (radius * reach for reach in disc_extents(axis))
    return (x - i, y - j, z - k), (x + i, y + j, z + k)


def bounds_of_points(*points: Triple) -> Bounds:
    """The bounding box of some points."""
    xs, ys, zs = zip(*points, strict=True)
    return (min(xs), min(ys), min(zs)), (max(xs), max(ys), max(zs))


def union_of_bounds(*boxes: Bounds) -> Bounds:
    """The bounding box of some boxes."""
    return bounds_of_points(*(corner for box in boxes for corner in box))
