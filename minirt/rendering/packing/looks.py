"""Looks: what the primitives of a scene are made of, where a mesh has several materials."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain

import numpy as np

from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.shapes import Shape
from minirt.shapes.mesh import Mesh


def looks_of(arrays: ShapeArrays) -> tuple[Sequence[Shape], np.ndarray]:
    """Return looks, shapes of one material each, and the index of each primitive's look, (n,).

    They are the shapes of the arrays; in place of a mesh come meshes with one of its materials each.
    """
    if Mesh not in arrays.group_numbers:
        return arrays.shapes, arrays.owner
    looks = [shape.looks if isinstance(shape, Mesh) else (shape,) for shape in arrays.shapes]
    look_of = np.cumsum([0, *map(len, looks)])[arrays.owner]
    for shape, start, end in zip(arrays.shapes, arrays.first_primitive, arrays.first_primitive[1:], strict=False):
        if isinstance(shape, Mesh):
            look_of[start:end] += shape.look_numbers()
    return tuple(chain.from_iterable(looks)), look_of


def by_primitive(arrays: ShapeArrays, name: str, rows: np.ndarray, look_of: np.ndarray) -> np.ndarray:
    """Return a row for each primitive, given one for each look, and the index of each primitive's look.

    It is the same array as the last one of this name while the rows are the same: a million triangles that are moved
    keep what they are made of. `arrays.of_looks` has the last rows of each name, and this array.
    """
    if name not in arrays.of_looks or not np.array_equal(arrays.of_looks[name][0], rows):
        arrays.of_looks[name] = rows, rows[look_of]
    return arrays.of_looks[name][1]
