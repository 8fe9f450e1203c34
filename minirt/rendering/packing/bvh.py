"""Builds the BVH of a scene: bounding boxes, SAH (Wald 2007), wide nodes, and blocks of shapes as its leaves."""

from __future__ import annotations

from typing import Any

import numpy as np

from minirt.kernel.bvh_build import BINS, GROUP, INDEX, BinaryTree
from minirt.kernel.bvh_nodes import GROUPS, NODE, REFERENCES, WIDTH, Group, Tree
from minirt.kernel.scene_arrays import kind_of, row_type
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.shapes import Kind

CACHE_LINE = 64  # bytes
NO_LEAF = -GROUPS  # a reference for the lanes to spare of a node, which rays of NaN hit, too: to a leaf of no group


def block_type(kind: Kind) -> np.dtype[Any]:
    """The dtype of the blocks of a kind: the row of a shape, with `WIDTH` shapes side by side."""
    fields = row_type(kind)
    return np.dtype([(name, np.float64, (*fields[name].shape, WIDTH)) for name in fields.names or ()])


def build_bvh(shape_arrays: ShapeArrays, kernel: Any) -> Tree:
    """Build the BVH over the shapes with the functions of `kernel`, compiled or interpreted."""
    kinds_are_infinite = [element.infinite for element in shape_arrays.group_numbers]
    is_infinite = np.array(kinds_are_infinite, bool)[shape_arrays.slots[:, 0]]
    infinite, bounded = np.flatnonzero(is_infinite), np.flatnonzero(~is_infinite)
    boxes = np.empty((len(bounded), 8))
    boxes[:, :3], boxes[:, 3:6] = -shape_arrays.boxes[bounded, 0], shape_arrays.boxes[bounded, 1]
    boxes[:, INDEX], boxes[:, GROUP] = bounded, shape_arrays.slots[bounded, 0]
    nodes, leaves = wide_nodes(boxes, kernel)
    # The blocks of each kind are in the order of the leaves.
    kinds = boxes[leaves[:, 0], GROUP]
    blocks = np.zeros(len(leaves), np.int64)
    extents = np.ascontiguousarray(shape_arrays.colours_and_extents[:, 3])
    groups = []
    for group, rows in enumerate(shape_arrays.rows):
        of_group = np.flatnonzero(kinds == group)
        blocks[of_group] = np.arange(len(of_group))
        start, stop = leaves[of_group, :2, None].transpose(1, 0, 2)
        members = boxes[np.minimum(start + np.arange(WIDTH), stop - 1), INDEX].astype(np.int64)
        group_blocks = as_blocks(rows, shape_arrays.slots[members, 1])
        labels = np.stack([members, extents[members]], axis=-1)
        unbounded = infinite[shape_arrays.slots[infinite, 0] == group]
        groups.append(Group(rows, group_blocks, labels, unbounded if kinds_are_infinite[group] else None, group))
    names = nodes.reshape(-1, 7, WIDTH)[:, 6]
    is_leaf = names < 0
    leaf = (-1 - names[is_leaf]).astype(np.int64)
    names[is_leaf] = -1 - (blocks[leaf] * GROUPS + kinds[leaf])
    names[names == 0] = NO_LEAF
    names[...] = names.astype(np.int32).view(np.uint32).astype(np.uint64).view(np.float64)
    return Tree(nodes, extents, shape_arrays.slots, tuple(groups))


def without_boxes(tree: Tree) -> Tree:
    """Widen all boxes of a BVH to all of space, so that each ray visits every leaf."""
    nodes = tree.nodes.copy()
    low, high = np.split(nodes.reshape(-1, NODE)[:, :REFERENCES], 2, axis=1)
    used = low <= high  # an unused child has an empty box
    low[used], high[used] = -np.inf, np.inf
    return tree._replace(nodes=nodes)


def wide_nodes(boxes: np.ndarray, kernel: Any) -> tuple[np.ndarray, np.ndarray]:
    """Build a binary tree over boxes, sorting them, and collapse it into wide nodes.

    Returns the nodes, and for each leaf its first box and the box behind its last.
    """
    most = max(1, 2 * len(boxes) - 1)
    links, bounds = np.empty((most, 3), np.int64), np.empty((most, 6))
    stack = np.empty((most + 1, 2), np.int64)
    tree = BinaryTree(boxes, bounds, links, np.empty((BINS + 1, 7)), np.empty(BINS), np.empty(6), stack)
    count = kernel.divide(tree)
    tree = tree._replace(bounds=bounds[:count], links=links[:count])
    nodes, leaves = aligned(NODE * (count // 2 + 1), np.dtype(np.float64)), np.empty(count, np.int64)
    used, named = kernel.collapse(tree, nodes, leaves, np.empty(WIDTH, np.int64))
    return nodes[: used * NODE], links[leaves[:named]]


def as_blocks(rows: np.ndarray, indices: np.ndarray) -> np.ndarray:
    """Gather the rows with some indices (n, WIDTH) into n blocks."""
    blocks = aligned(len(indices), block_type(kind_of(rows.dtype.names)))
    for name in rows.dtype.names or ():
        blocks[name] = np.moveaxis(rows[name][indices], 1, -1)
    return blocks


def aligned(length: int, dtype: np.dtype[Any]) -> np.ndarray:
    """Allocate an array aligned to a cache line, so that no load into a SIMD register needs two lines."""
    memory = np.empty(length * dtype.itemsize + CACHE_LINE, np.uint8)
    start = -memory.ctypes.data % CACHE_LINE
    return memory[start : start + length * dtype.itemsize].view(dtype)
