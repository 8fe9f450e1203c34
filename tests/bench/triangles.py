"""Lights and shapes as the peers take them: planes, cylinders and meshes as triangles."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.fields import Triple
from minirt.scene import Ambient, Light
from minirt.shapes import Cylinder, Mesh, Plane, Shape

SIDES = 64  # of a cylinder
ENDLESS = 1e5  # half of an edge of a plane


class Triangles(NamedTuple):
    """Triangles that share points."""

    points: NDArray[np.float64]  # (n, 3)
    corners: NDArray[Any]  # (m, 3) indices of points


def triangulated(shape: Shape) -> Triangles:
    """Return the triangles of a plane, a large square; of a cylinder, a prism of SIDES sides; or of a mesh."""
    if isinstance(shape, Mesh):
        return Triangles(shape.placed(shape.triangles.points), shape.triangles.corners)
    assert isinstance(shape, Cylinder | Plane), f"no triangles for {shape}"
    axis = np.array(shape.axis if isinstance(shape, Cylinder) else shape.normal)
    u = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])  # u and v are perpendicular to the axis and to each other
    u /= np.linalg.norm(u)
    v = np.cross(axis, u)
    if isinstance(shape, Cylinder):
        angles = np.arange(SIDES) * (2 * np.pi / SIDES)
        around = shape.diameter / 2 * (np.outer(np.cos(angles), u) + np.outer(np.sin(angles), v))
        low, high = (np.array(shape.centre) + end * shape.height / 2 * axis for end in (-1, 1))
        a, b = low + around, high + around
        c, d = np.roll(a, -1, axis=0), np.roll(b, -1, axis=0)  # the next edge
        bottom, top = (np.broadcast_to(end, a.shape) for end in (low, high))
        faces = [np.stack(face, axis=1) for face in ((a, c, d), (a, d, b), (bottom, a, c), (top, b, d))]
    else:
        turns = [sign * ENDLESS * u + side * ENDLESS * v for sign, side in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        square = np.array(shape.point) + turns
        faces = [square[[[0, 1, 2], [0, 2, 3]]]]
    points = np.concatenate(faces).reshape(-1, 3)
    return Triangles(points, np.arange(len(points)).reshape(-1, 3))


def light(source: Ambient | Light | None) -> Triple:
    """Return the radiance of a light source, red green blue in [0, 1]; black for None."""
    if source is None:
        return 0.0, 0.0, 0.0
    red, green, blue = (source.brightness * level / 255 for level in source.colour)
    return red, green, blue
