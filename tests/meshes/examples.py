"""Example meshes, and brute-force intersection of rays with their triangles."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from minirt.fields import MeshFile
from minirt.meshes import Triangles, load_mesh
from minirt.shapes.mesh import Mesh
from tests.paths import SCENES

FOLDER = SCENES / "meshes"
GREY = (200, 200, 200)
Array = NDArray[np.float64]


def named(name: str, position: tuple[float, float, float] = (0, 0, 0), scale: float = 1.0, **how: Any) -> Mesh:
    """Load a mesh of scenes/meshes."""
    return Mesh(MeshFile(f"{name}.obj", load_mesh(FOLDER / f"{name}.obj")), position, scale, GREY, **how)


def soup(random: np.random.Generator, count: int, size: float = 1.0) -> Mesh:
    """Make a triangle soup: unconnected random triangles."""
    points = random.normal(size=(count, 1, 3)) * 3 + size * random.normal(size=(count, 3, 3))
    corners = np.arange(3 * count).reshape(count, 3)
    return Mesh(MeshFile("soup.obj", Triangles(points.reshape(-1, 3), corners)), (0, 0, 0), 1.0, GREY)


@cache
def ball(subdivisions: int) -> Triangles:
    """Return a triangulated unit sphere with the sphere's normals at the corners."""
    triangles = load_mesh(FOLDER / "icosphere.obj" if subdivisions == 3 else FOLDER / "icosahedron.obj")
    points = triangles.points / np.linalg.norm(triangles.points, axis=1)[:, None]
    return Triangles(points, triangles.corners, points[triangles.corners])


def first_hits(corners: Array, origins: Array, directions: Array) -> tuple[Array, NDArray[np.int64], Array]:
    """Return for each ray the distance of its closest hit, the triangle, and its least distance from an edge.

    The latter is a barycentric coordinate: when it is near 0, rounding decides. Möller and Trumbore, Fast, Minimum
    Storage Ray/Triangle Intersection, 1997.
    """
    nearest, owner = np.full(len(origins), np.inf), np.full(len(origins), -1)
    doubt = np.full(len(origins), np.inf)
    for i, (a, b, c) in enumerate(corners):
        p = np.cross(directions, c - a)
        determinant = p @ (b - a)
        with np.errstate(all="ignore"):
            u = np.einsum("ij,ij->i", origins - a, p) / determinant
            q = np.cross(origins - a, b - a)
            v = np.einsum("ij,ij->i", directions, q) / determinant
            t = q @ (c - a) / determinant
        inside = np.minimum(np.minimum(u, v), 1 - u - v)
        doubt = np.minimum(doubt, np.where(t > 0, np.abs(inside), np.inf))
        hit = (inside >= 0) & (t > 0) & (t < nearest)
        nearest[hit], owner[hit] = t[hit], i
    return nearest, owner, doubt
