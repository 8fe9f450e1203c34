"""Normals of the planes of triangles, exact to a few roundings.

A plain cross product of two edges has four correct digits for a sliver with an aspect ratio of 1e-12: the products
cancel. So differences, products and sums keep their rounding errors here.
"""

from __future__ import annotations

import numpy as np

from minirt.lanes import Number, Vec, dot, max_norm, unit, where
from minirt.shapes.compensated import Pair, minus, offset, times, value


def plane_normal(a: Vec, b: Vec, c: Vec) -> Vec:
    """Cross product of b - a and c - a, exact to a few roundings; its length is twice the area of the triangle."""
    (x, y, z), (u, v, w) = offset(b, a), offset(c, a)
    return Vec(cross_component(y, z, v, w), cross_component(z, x, w, u), cross_component(x, y, u, v))


def plane_normal_towards(a: Vec, b: Vec, c: Vec, approximate: Vec) -> Vec:
    """Unit normal of the plane of a triangle, on the side of the `approximate` normal, which is kept where the corners
    lie on a line."""
    normal = plane_normal(a, b, c)
    normal = where(max_norm(normal) > 0.0, normal, approximate)
    normal = where(dot(normal, approximate) < 0.0, -normal, normal)
    return unit(normal / max_norm(normal))


def cross_component(y: Pair, z: Pair, v: Pair, w: Pair) -> Number:
    """y w - z v."""
    return value(minus(times(y, w), times(z, v)))


def plane_normals(corners: np.ndarray, approximate: np.ndarray) -> np.ndarray:
    """Unit normals of triangles whose corners are rows of nine numbers, on the side of the `approximate` normals."""
    columns = corners.T.copy()
    a, b, c, side = Vec(*columns[:3]), Vec(*columns[3:6]), Vec(*columns[6:]), Vec(*approximate.T.copy())
    normal = plane_normal_towards(a, b, c, side)
    return np.stack([normal.x, normal.y, normal.z], axis=1)
