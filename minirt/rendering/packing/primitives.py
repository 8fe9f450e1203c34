"""What the kernel keeps of shapes, which of most is one thing, and of a mesh one for each triangle."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from minirt.element import fields_of
from minirt.fields import Point
from minirt.lanes import Vec
from minirt.shapes import Ball, Shape
from minirt.shapes.mesh import Mesh

EVERYWHERE: tuple[Ball, ...] = (((0.0, 0.0, 0.0), np.inf),)  # where a shape lies that has no end and is no plane


class Primitives(NamedTuple):
    """The n parts of shapes of a kind, one shape after the other."""

    rows: np.ndarray  # (n, r) their packed form, number by number
    boxes: np.ndarray  # (n, 2, 3) least and greatest corner; of one without end, its points
    balls: np.ndarray  # (n, b, 4) centre and radius: each lies in the hull of b balls; none around planes


def primitives_of(shapes: list[Shape]) -> Primitives:
    """The parts of some shapes of a kind."""
    if isinstance(shapes[0], Mesh):
        rows = [shape.rows() for shape in shapes if isinstance(shape, Mesh)]
        return Primitives(*map(np.concatenate, zip(*map(triangle_primitives, rows), strict=True)))
    return Primitives(packed_rows([shape.pack() for shape in shapes]), bounding_boxes(shapes), bounding_balls(shapes))


def triangle_primitives(rows: np.ndarray) -> Primitives:
    """Those of the triangles of a mesh: the corners come first in a row."""
    corners = rows[:, :9].reshape(-1, 3, 3)
    balls = np.zeros((len(rows), 3, 4))
    balls[..., :3] = corners
    a, b, c = corners.transpose(1, 0, 2)
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    return Primitives(rows, np.stack([low, high], axis=1), balls)


def bounding_balls(shapes: list[Shape]) -> np.ndarray:
    """`Parts.balls`."""
    if isinstance(shapes[0], Mesh):
        return primitives_of(shapes).balls
    hulls = [() if shape.flat() else shape.balls() or EVERYWHERE for shape in shapes]
    return np.array([[(*centre, radius) for centre, radius in hull] for hull in hulls]).reshape(len(shapes), -1, 4)


def packed_rows(packed: list[Any]) -> np.ndarray:
    """Packed shapes of a kind, a row each."""
    columns: list[Any] = []
    for parts in zip(*packed, strict=True):
        if isinstance(parts[0], Vec):
            columns += [[v.x for v in parts], [v.y for v in parts], [v.z for v in parts]]
        else:
            columns.append(parts)
    return np.array(columns).T


def bounding_boxes(shapes: list[Shape]) -> np.ndarray:
    """For each shape of a kind the corners of the box around it, (n, 2, 3); of one without end, its points."""
    return np.array([shape.bounds() or defining_points(shape) for shape in shapes])


def extent(shape: Shape) -> float:
    """The largest coordinate of a shape; of one without end, the largest of its points."""
    return float(np.abs(bounding_boxes([shape])).max())


def defining_points(shape: Shape) -> list[Any]:
    """The points that a shape is given by."""
    return [getattr(shape, each.name) for each in fields_of(type(shape)) if isinstance(each, Point)]
