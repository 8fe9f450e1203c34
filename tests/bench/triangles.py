"""Lights and shapes as the peers take them: planes, cylinders and meshes as triangles."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.fields import Triple
from minirt.scene import Ambient, Light
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.mesh import Mesh
from minirt.shapes.plane import Plane
from minirt.shapes.shape import Shape

Corners = NDArray[np.float64]  # (n, 3, 3) points of the corners of triangles

SIDES = 64  # of a cylinder
ENDLESS = 1e5  # half of an edge of a plane


class Triangles(NamedTuple):
    """Triangles that share points."""

    points: NDArray[np.float64]  # (n, 3)
    corners: NDArray[Any]  # (m, 3) indices of points


def triangulated(shape: Shape) -> Triangles:
    """Return the triangles of a plane, a cylinder or a mesh."""
    match shape:
        case Mesh():
            return Triangles(shape.placed(shape.triangles.points), shape.triangles.corners)
        case Cylinder():
            corners = cylinder(shape)
        case Plane():
            corners = plane(shape)
        case _:
            raise ValueError(f"no triangles for {shape}")
    return Triangles(corners.reshape(-1, 3), np.arange(corners.size // 3).reshape(-1, 3))


def across(axis: Triple) -> tuple[Corners, Corners]:
    """Two unit vectors perpendicular to an axis and to each other."""
    u = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    u /= np.linalg.norm(u)
    return u, np.cross(axis, u)


def cylinder(shape: Cylinder) -> Corners:
    """Approximate a cylinder by a prism of SIDES sides that touches it at its edges."""
    u, v = across(shape.axis)
    angles = np.arange(SIDES) * (2 * np.pi / SIDES)
    around = shape.diameter / 2 * (np.outer(np.cos(angles), u) + np.outer(np.sin(angles), v))
    low, high = (np.array(shape.centre) + end * shape.height / 2 * np.array(shape.axis) for end in (-1, 1))
    a, b = low + around, high + around
    c, d = np.roll(a, -1, axis=0), np.roll(b, -1, axis=0)  # the next edge
    centres = [np.broadcast_to(end, a.shape) for end in (low, high)]
    faces = [(a, c, d), (a, d, b), (centres[0], a, c), (centres[1], b, d)]
    return np.concatenate([np.stack(face, axis=1) for face in faces])


def plane(shape: Plane) -> Corners:
    """Approximate a plane by a large square."""
    u, v = (ENDLESS * each for each in across(shape.normal))
    point = np.array(shape.point)
    return np.array([[point - u - v, point + u - v, point + u + v], [point - u - v, point + u + v, point - u + v]])


def light(source: Ambient | Light | None) -> Triple:
    """Return the radiance of a light source, red green blue in [0, 1]; black for None."""
    if source is None:
        return 0.0, 0.0, 0.0
    red, green, blue = (source.brightness * level / 255 for level in source.colour)
    return red, green, blue
