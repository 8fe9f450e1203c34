"""Meshes that tests begin with, and brute force to know where rays hit them."""

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
    """A mesh of scenes/meshes."""
    return Mesh(MeshFile(f"{name}.obj", load_mesh(FOLDER / f"{name}.obj")), position, scale, GREY, **how)


def soup(random: np.random.Generator, count: int, size: float = 1.0) -> Mesh:
    """Triangles that have nothing to do with each other."""
    points = random.normal(size=(count, 1, 3)) * 3 + size * random.normal(size=(count, 3, 3))
    corners = np.arange(3 * count).reshape(count, 3)
    return Mesh(MeshFile("soup.obj", Triangles(points.reshape(-1, 3), corners)), (0, 0, 0), 1.0, GREY)


@cache
def ball(subdivisions: int) -> Triangles:
    """A sphere of triangles with the sphere's normals at the corners."""
    made = load_mesh(FOLDER / "icosphere.obj" if subdivisions == 3 else FOLDER / "icosahedron.obj")
    points = made.points / np.linalg.norm(made.points, axis=1)[:, None]
    return Triangles(points, made.corners, points[made.corners])


def first_hits(corners: Array, origins: Array, directions: Array) -> tuple[Array, NDArray[np.int64], Array]:
    """Distances of the first hits of rays with triangles, which they are, and how near to an edge the ray passes that
    decides it, in shares of a triangle. Moeller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997."""
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
