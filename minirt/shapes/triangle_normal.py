"""Normal of the plane through three points, accurate for slivers too.

A plain cross product of two edges has four correct digits for a sliver with an aspect ratio of 1e-12: the products
cancel. So differences, products and sums keep their rounding errors here.
"""

from __future__ import annotations

import numpy as np

from minirt.lanes import Number, Vec
from minirt.meshes.triangles import unit
from minirt.shapes.compensated import two_product, two_sum

BLOCK = 16384  # triangles whose normals are computed at a time, in the cache of a core: twice as fast as all at once
Pair = tuple[Number, Number]  # a rounded number and its rounding error


def plane_normal(a: Vec, b: Vec, c: Vec) -> Vec:
    """Cross product of b - a and c - a, exact to a few roundings; its length is twice the area of the triangle."""
    (x, y, z), (u, v, w) = edge(a, b), edge(a, c)
    return Vec(cross_component(y, z, v, w), cross_component(z, x, w, u), cross_component(x, y, u, v))


def edge(p: Vec, q: Vec) -> tuple[Pair, Pair, Pair]:
    """The exact vector from p to q."""
    return two_sum(q.x, -p.x), two_sum(q.y, -p.y), two_sum(q.z, -p.z)


def cross_component(y: Pair, z: Pair, v: Pair, w: Pair) -> Number:
    """y w - z v."""
    yw, yw_low = two_product(y[0], w[0])
    zv, zv_low = two_product(z[0], v[0])
    total, low = two_sum(yw, -zv)
    return total + (low + (yw_low - zv_low) + ((y[0] * w[1] + y[1] * w[0]) - (z[0] * v[1] + z[1] * v[0])))


def plane_normals(corners: np.ndarray, approximate: np.ndarray) -> np.ndarray:
    """Unit normals of triangles whose corners are rows of nine numbers, on the side of the `approximate` normals.

    Where the corners lie on a line, once placed in the scene, the approximate normal is kept.
    """
    normals = np.empty((len(corners), 3))
    for start in range(0, len(corners), BLOCK):
        columns = corners[start : start + BLOCK].T.copy()
        normal = plane_normal(Vec(*columns[:3]), Vec(*columns[3:6]), Vec(*columns[6:]))
        normals[start : start + BLOCK] = np.stack([normal.x, normal.y, normal.z], axis=1)
    flat = ~normals.any(axis=1)
    normals[flat] = approximate[flat]
    normals[np.einsum("ij,ij->i", normals, approximate) < 0] *= -1
    return unit(normals)
