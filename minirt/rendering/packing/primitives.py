"""Primitives: the things that rays are tested against, one for most shapes, and one for each triangle of a mesh."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from minirt.element import fields_of
from minirt.fields import Point
from minirt.lanes import Vec
from minirt.shapes import Ball, Shape
from minirt.shapes.mesh import Mesh

EVERYWHERE: tuple[Ball, ...] = (((0.0, 0.0, 0.0), np.inf),)  # of an infinite shape that is no plane


class Primitives(NamedTuple):
    """The n primitives of shapes of a kind, in the order of the shapes."""

    rows: np.ndarray  # (n, r) the numbers of their packed form
    boxes: np.ndarray  # (n, 2, 3) least and greatest corner; of an infinite shape, its defining points
    balls: np.ndarray  # (n, b, 4) centre and radius: each primitive lies in the hull of b balls; planes have none


def primitives_of(shapes: list[Shape]) -> Primitives:
    """Pack the primitives of some shapes of one kind."""
    if isinstance(shapes[0], Mesh):
        rows = [shape.rows() for shape in shapes if isinstance(shape, Mesh)]
        return Primitives(*map(np.concatenate, zip(*map(triangle_primitives, rows), strict=True)))
    return Primitives(packed_rows([shape.pack() for shape in shapes]), bounding_boxes(shapes), bounding_balls(shapes))


def triangle_primitives(rows: np.ndarray) -> Primitives:
    """The primitives of a mesh, from its packed triangles; a row begins with the corners of the triangle."""
    corners = rows[:, :9].reshape(-1, 3, 3)
    balls = np.zeros((len(rows), 3, 4))
    balls[..., :3] = corners
    a, b, c = corners.transpose(1, 0, 2)
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    return Primitives(rows, np.stack([low, high], axis=1), balls)


def bounding_balls(shapes: list[Shape]) -> np.ndarray:
    """The balls of `Primitives` for some shapes of one kind."""
    if isinstance(shapes[0], Mesh):
        return primitives_of(shapes).balls
    hulls = [() if shape.flat() else shape.balls() or EVERYWHERE for shape in shapes]
    return np.array([[(*centre, radius) for centre, radius in hull] for hull in hulls]).reshape(len(shapes), -1, 4)


def packed_rows(packed: list[Any]) -> np.ndarray:
    """Flatten packed shapes of one kind into rows of numbers, one a shape."""
    columns: list[Any] = []
    for parts in zip(*packed, strict=True):
        if isinstance(parts[0], Vec):
            columns += [[v.x for v in parts], [v.y for v in parts], [v.z for v in parts]]
        else:
            columns.append(parts)
    return np.array(columns).T


def bounding_boxes(shapes: list[Shape]) -> np.ndarray:
    """Corners of the bounding boxes of shapes of one kind, (n, 2, 3); of an infinite shape, its defining points."""
    return np.array([shape.bounds() or defining_points(shape) for shape in shapes])


def extent(shape: Shape) -> float:
    """The largest absolute coordinate of a shape; of an infinite shape, of its defining points."""
    return float(np.abs(bounding_boxes([shape])).max())


def defining_points(shape: Shape) -> list[Any]:
    """The points among the fields that define a shape."""
    return [getattr(shape, each.name) for each in fields_of(type(shape)) if isinstance(each, Point)]
