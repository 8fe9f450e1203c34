"""Builds the BVH of a scene: bounding boxes, SAH (Wald 2007), wide nodes, and blocks of shapes as its leaves."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

from minirt.kernel.bvh_build import GROUP, INDEX, BinaryTree
from minirt.kernel.bvh_nodes import GROUPS, MARGIN, NODE, WIDTH, LeafGroup, Tree
from minirt.kernel.machine_code.library import bound
from minirt.kernel.mesh_nodes import MeshTrees
from minirt.kernel.scene_arrays import KIND, ROW, MeshTriangles, kind_of, row_type
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.packing.visibility import PARALLEL, Run
from minirt.shapes import Kind, Mesh

Meshes: TypeAlias = tuple[MeshTrees | None, MeshTriangles | None]
NO_MESHES = None, None
PARTS = 4  # into about so many a thread divides a tree before all threads divide these
CACHE_LINE = 64  # bytes
NO_LEAF = -GROUPS  # a reference for the lanes to spare of a node, which rays of NaN hit, too: to a leaf of no group


def block_type(kind: Kind) -> np.dtype[Any]:
    """The dtype of the blocks of a kind: the row of a shape, with `WIDTH` shapes side by side."""
    fields = row_type(kind)
    return np.dtype([(name, np.float64, (*fields[name].shape, WIDTH)) for name in fields.names or ()])


def build_bvh(
    shape_arrays: ShapeArrays, kernel: Any, margin: float = MARGIN, run: Run | None = None, meshes: Meshes = NO_MESHES
) -> Tree:
    """Build the BVH over the shapes with the functions of `kernel`, compiled or interpreted.

    A mesh is one shape in it, and has a tree of its own: `meshes` are these trees and the triangles of all meshes.
    All boxes are grown by a margin, a share of their coordinates. Where it is infinite each ray visits every leaf.
    """
    first = shape_arrays.first_primitive[:-1]  # the primitive of each shape, the first one of a mesh
    slots, bounds, extents = shape_arrays.slots[first], shape_arrays.boxes, shape_arrays.colours_and_extents[:, 3]
    kinds_are_infinite = [element.infinite for element in shape_arrays.group_numbers]
    is_infinite = np.array(kinds_are_infinite, bool)[slots[:, KIND]]
    infinite, bounded = first[is_infinite], np.flatnonzero(~is_infinite)
    boxes = np.empty((len(bounded), 8))
    boxes[:, :3], boxes[:, 3:6] = -bounds[bounded, 0], bounds[bounded, 1]
    boxes[:, INDEX], boxes[:, GROUP] = first[bounded], slots[bounded, KIND]
    nodes, leaves = wide_nodes(boxes, kernel, margin=margin, run=run)
    # The blocks of each kind are in the order of the leaves.
    kinds, (places, spare) = boxes[leaves[:, 0], GROUP], lanes_of(leaves, WIDTH)
    blocks = np.zeros(len(leaves), np.int64)
    groups = []
    for group, (kind, rows) in enumerate(zip(shape_arrays.group_numbers, shape_arrays.tables, strict=True)):
        of_group = np.flatnonzero(kinds == group)
        blocks[of_group] = np.arange(len(of_group))
        members = boxes[places[of_group], INDEX].astype(np.int64)
        group_blocks = shape_arrays.slots[members, ROW]
        if kind is not Mesh:
            group_blocks = as_blocks(rows, group_blocks)
        labels = np.stack([members, extents[members]], axis=-1)
        leaf_boxes = aligned_copy(boxes_of(boxes[:, :6], places[of_group], spare[of_group], margin))
        unbounded = infinite[shape_arrays.slots[infinite, KIND] == group] if kinds_are_infinite[group] else None
        of_meshes = meshes if kind is Mesh else NO_MESHES
        groups.append(LeafGroup(rows, group_blocks, labels, leaf_boxes, unbounded, group, *of_meshes))
    refer_to_leaves(nodes[:, 6], blocks, kinds)
    return Tree(aligned_copy(nodes), extents.copy(), shape_arrays.slots, tuple(groups))


def refer_to_leaves(references: np.ndarray, blocks: np.ndarray, groups: np.ndarray) -> None:
    """Replace the references of `wide_nodes`, (n, WIDTH), by those of `Tree`. Leaf i is a block, `blocks[i]`, of the
    group `groups[i]`.

    A reference is an integer, whose bits are those of a float64 here.
    """
    is_leaf = references < 0
    leaf = (-1 - references[is_leaf]).astype(np.int64)
    references *= NODE
    references[is_leaf] = -1 - (blocks[leaf] * GROUPS + groups[leaf])
    references[references == 0] = NO_LEAF  # lanes to spare: no node has the root as a child
    references[...] = references.astype(np.int32).view(np.uint32).astype(np.uint64).view(np.float64)


def lanes_of(leaves: np.ndarray, width: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the boxes of each leaf, (n, width), the last one also in lanes to spare, and which lanes these are."""
    start, stop = leaves[:, :2, None].transpose(1, 0, 2)
    places = start + np.arange(width)
    return np.minimum(places, stop - 1), places >= stop


def boxes_of(bounds: np.ndarray, places: np.ndarray, spare: np.ndarray, margin: float) -> np.ndarray:
    """Return the low x, y, z and high x, y, z of boxes, (n, 6, width), by the places of their bounds, (n, width); no
    ray hits those of lanes to `spare`."""
    boxes = np.ascontiguousarray(bounds[places].transpose(0, 2, 1))  # a tree takes 0.94 of the time
    if margin:
        boxes += margin * np.abs(boxes).max(axis=1, keepdims=True)
    boxes[:, :3] *= -1.0
    boxes.transpose(0, 2, 1)[spare] = np.repeat([np.inf, -np.inf], 3)
    return boxes


def wide_nodes(
    boxes: np.ndarray, kernel: Any, width: int = WIDTH, margin: float = MARGIN, run: Run | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Build a binary tree over boxes, (m, 8) as in `BinaryTree`, with the functions of `kernel`, and collapse it into
    nodes of some width. The boxes are sorted: `boxes` is written.

    Return the nodes, (n, 7, width), and the links of the leaves, (k, 3): the first box of each and the box behind its
    last. A node has the boxes of its children, grown by a share, `margin`, of their coordinates, and the references of
    `collapse` to these. With `run` all threads divide the tree.
    """
    room = max(1, 2 * len(boxes) - 1)  # nodes of the tree, at most
    links, bounds, found = np.empty((room, 3), np.int64), np.empty((room, 6)), np.array([1, 0])
    tree = BinaryTree(boxes, bounds, links, found, width)
    links[0, :2], roots, most = (0, len(boxes)), np.zeros((1, 2), np.int64), len(boxes)  # the root, of all boxes
    while len(roots):
        most = most // PARTS if run and most >= PARALLEL * PARTS else 0
        job = bound(kernel.divide, np.zeros(1, np.int64), tree, roots, most)
        if run and len(roots) > 1:
            run(job)
        else:
            job()
        left = np.flatnonzero(links[: found[0], 2] < 0)  # nodes that `divide` has left, with -1 - level
        roots = np.stack([left, -1 - links[left, 2]], axis=1)
    children, references = np.empty((2, found[0] // 2 + 1, width), np.int64)
    leaves, areas = np.empty(found[0], np.int64), np.empty((found[0], width))
    kernel.collapse(tree, areas, np.empty((found[0], width + 1), np.int8), children, references, leaves)
    node_count, leaf_count = found
    children, references = children[:node_count], references[:node_count, None]
    with np.errstate(invalid="ignore"):  # an empty tree has a box of infinities
        nodes = np.concatenate([boxes_of(bounds, children, children < 0, margin), references], axis=1)
    return nodes, links[leaves[:leaf_count]]


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


def aligned_copy(numbers: np.ndarray) -> np.ndarray:
    """Copy numbers into a flat aligned array."""
    flat = aligned(numbers.size, numbers.dtype)
    flat[...] = numbers.ravel()
    return flat
