"""Lengths of shapes, from their fields."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from minirt.element import fields_of
from minirt.fields import Length, Lengths, Point
from minirt.rendering.packing.shape_arrays import bounding_boxes
from minirt.shapes import Shape
from minirt.shapes.mesh import Mesh


def sizes(shapes: Sequence[Shape]) -> NDArray[np.float64]:
    """Return the lengths that define each shape of one type, or the distances of its points, (n, k).

    A plane has none; a mesh has the diagonal of its bounding box.
    """
    if isinstance(shapes[0], Mesh):
        diagonals: NDArray[np.float64] = np.linalg.norm(np.diff(bounding_boxes(list(shapes)), axis=1)[:, 0], axis=1)
        return diagonals[:, None]

    def columns(*sorts: type) -> list[NDArray[np.float64]]:
        names = [each.name for each in fields_of(type(shapes[0])) if isinstance(each, sorts) and each.required]
        return [np.array([getattr(shape, name) for shape in shapes], float).reshape(len(shapes), -1) for name in names]

    points = columns(Point)
    sides = [np.linalg.norm(one - points[i - 1], axis=1, keepdims=True) for i, one in enumerate(points)]
    return np.hstack([*columns(Length, Lengths), *(sides if len(points) > 1 else ())] or [np.zeros((len(shapes), 0))])
