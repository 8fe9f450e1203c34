"""The shapes of a scene in the tree of the kernel."""

from __future__ import annotations

from typing import Any

import numpy as np

from minirt.kernel.bvh.build import BINS, GROUP, INDEX, BinaryTree
from minirt.kernel.bvh.nodes import NODE, WIDTH, Group, Tree
from minirt.kernel.rows import kind_of, row_type
from minirt.rendering.packing.primitives import primitives_of
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.shapes import Kind

LINE = 64  # bytes of a line of the cache
EMPTY = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


def block_type(kind: Kind) -> np.dtype[Any]:
    """The dtype of the blocks of a kind: a row for `WIDTH` shapes at once."""
    fields = row_type(kind)
    return np.dtype([(name, np.float64, (*fields[name].shape, WIDTH)) for name in fields.names or ()])


def boxes_of(tables: ShapeArrays) -> tuple[np.ndarray, np.ndarray]:
    """The boxes of the shapes as `BinaryTree` has them, and the indices of the shapes that have no end."""
    bounds = [shape.bounds() for shape in tables.shapes]
    endless = tables.start[np.array([index for index, box in enumerate(bounds) if not box], np.int64)]
    bounded = np.delete(np.arange(len(tables.slots)), endless)
    corners = np.repeat([box or EMPTY for box in bounds], np.diff(tables.start), axis=0)
    for index, shape in enumerate(tables.shapes):
        if shape.parts > 1:
            corners[tables.start[index] : tables.start[index + 1]] = primitives_of([shape]).boxes
    boxes = np.empty((len(bounded), 8))
    boxes[:, :3], boxes[:, 3:6] = -corners[bounded, 0], corners[bounded, 1]
    boxes[:, INDEX], boxes[:, GROUP] = bounded, tables.slots[bounded, 0]
    return boxes, endless


def bvh_of(tables: ShapeArrays, kernel: Any) -> Tree:
    """The tree over the shapes of some tables, built by the functions of `kernel`, compiled or not."""
    boxes, endless = boxes_of(tables)
    nodes, leaves = wide_nodes(boxes, kernel)
    # Each kind has its blocks in the order of the leaves.
    kinds = boxes[leaves[:, 0], GROUP]
    blocks = np.zeros(len(leaves), np.int64)
    extents = np.ascontiguousarray(tables.colours_and_extents[:, 3])
    groups = []
    for group, rows in enumerate(tables.rows):
        mine = np.flatnonzero(kinds == group)
        blocks[mine] = np.arange(len(mine))
        start, stop = leaves[mine, :2, None].transpose(1, 0, 2)
        owners = boxes[np.minimum(start + np.arange(WIDTH), stop - 1), INDEX].astype(np.int64)
        table = side_by_side(rows, tables.slots[owners, 1])
        labels = np.stack([owners, extents[owners]], axis=-1)
        groups.append(Group(rows, table, labels, endless[tables.slots[endless, 0] == group]))
    names = nodes.reshape(-1, 7, WIDTH)[:, 6]
    leaf = names < 0
    which = (-1 - names[leaf]).astype(np.int64)
    names[leaf] = -1 - (blocks[which] * len(groups) + kinds[which])
    names[...] = names.astype(np.int32).view(np.uint32).astype(np.uint64).view(np.float64)
    return Tree(nodes, extents, tables.slots, tuple(groups))


def wide_nodes(boxes: np.ndarray, kernel: Any) -> tuple[np.ndarray, np.ndarray]:
    """The nodes of the tree over boxes, which are sorted by it, and for each leaf its first box and that behind its
    last."""
    most = max(1, 2 * len(boxes) - 1)
    whole, reaches = np.empty((most, 3), np.int64), np.empty((most, 6))
    todo = np.empty((most + 1, 2), np.int64)
    tree = BinaryTree(boxes, reaches, whole, np.empty((BINS + 1, 7)), np.empty(BINS), np.empty(6), todo)
    count = kernel.divide(tree)
    tree = tree._replace(bounds=reaches[:count], links=whole[:count])
    choices = np.empty((count, WIDTH + 1), np.int64)
    kernel.weigh(tree, np.empty((count, WIDTH + 1)), choices)
    nodes, leaves = aligned(NODE * (count // 2 + 1), np.dtype(np.float64)), np.empty(count, np.int64)
    used, named = kernel.collapse(tree, choices, nodes, leaves, todo, np.empty((WIDTH, 2), np.int64))
    return nodes[: used * NODE], whole[leaves[:named]]


def side_by_side(rows: np.ndarray, places: np.ndarray) -> np.ndarray:
    """The rows at some places (n, WIDTH) as n blocks."""
    blocks = aligned(len(places), block_type(kind_of(rows.dtype.names)))
    for name in rows.dtype.names or ():
        blocks[name] = np.moveaxis(rows[name][places], 1, -1)
    return blocks


def aligned(length: int, dtype: np.dtype[Any]) -> np.ndarray:
    """An array that begins with a line of the cache, so that no load of lanes needs two."""
    memory = np.empty(length * dtype.itemsize + LINE, np.uint8)
    start = -memory.ctypes.data % LINE
    return memory[start : start + length * dtype.itemsize].view(dtype)
