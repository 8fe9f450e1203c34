"""Builds BVHs: bounding boxes, SAH (Wald 2007) and wide nodes; and of a scene, blocks of shapes as its leaves."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

from minirt.kernel.bvh_build import GROUP, INDEX, BinaryTree
from minirt.kernel.bvh_nodes import MARGIN, NODE, ROUNDING, WIDE, LeafGroup, MeshTrees, Tree
from minirt.kernel.machine_code.library import bound
from minirt.kernel.scene_arrays import KIND, ROW, MeshTriangles, kind_of, row_type
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.packing.visibility import PARALLEL, Run
from minirt.shapes import Kind, Mesh

Meshes: TypeAlias = tuple[MeshTrees | None, MeshTriangles | None]
NO_MESHES = None, None
PARTS = 4  # into about so many a thread divides a tree before all threads divide these
CACHE_LINE = 64  # bytes


def block_type(kind: Kind) -> np.dtype[Any]:
    """The dtype of the blocks of a kind: the row of a shape, with `WIDE` shapes side by side."""
    fields = row_type(kind)
    return np.dtype([(name, np.float64, (*fields[name].shape, WIDE)) for name in fields.names or ()])


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
    low, high = bounds[bounded].transpose(1, 0, 2)
    middle, size = space_around(low, high)
    boxes = np.empty((len(bounded), 8))
    boxes[:, :3], boxes[:, 3:6] = (middle - low) / size, (high - middle) / size
    boxes[:, INDEX], boxes[:, GROUP] = first[bounded], slots[bounded, KIND]
    nodes, inside, spare = wide_nodes(boxes, kernel, margin, run)
    node_count, kinds = len(nodes) - len(inside), boxes[inside[:, 0], GROUP]
    nodes[node_count:, :6] = boxes_of(boxes[:, :6], inside, spare, margin)
    groups = []
    for group, (kind, rows) in enumerate(zip(shape_arrays.group_numbers, shape_arrays.tables, strict=True)):
        start, stop = np.searchsorted(kinds, (group, group + 1)).tolist()
        members = boxes[inside[start:stop], INDEX].astype(np.int64)
        group_blocks = shape_arrays.slots[members, ROW]
        if kind is not Mesh:
            group_blocks = as_blocks(rows, group_blocks)
        labels = np.stack([members, extents[members]], axis=-1)
        unbounded = infinite[shape_arrays.slots[infinite, KIND] == group] if kinds_are_infinite[group] else None
        of_meshes = meshes if kind is Mesh else NO_MESHES
        groups.append(LeafGroup(rows, group_blocks, labels, unbounded, node_count + start, group, *of_meshes))
    place = np.array([*np.eye(3).ravel(), *middle, 1.0 / size, 0.0])
    return Tree(aligned_copy(nodes), place, extents.copy(), shape_arrays.slots, tuple(groups))


def space_around(low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, float]:
    """Return the origin of the space of a scene's tree, and what is 1 there, for the corners of its boxes, (n, 3).

    Boxes and rays are the more exact the closer they are to the origin, which is among most of the shapes: so these
    are told apart beside a ground that is a huge sphere, too."""
    if not len(low):
        return np.zeros(3), 1.0
    middle: np.ndarray = np.median(low / 2 + high / 2, axis=0)
    return middle, float(np.maximum(middle - low, high - middle).max()) or 1.0


def wide_nodes(
    boxes: np.ndarray, kernel: Any, margin: float = MARGIN, run: Run | None = None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Build a binary tree over boxes, sorting them, on all threads by `run`, and collapse it into wide nodes; see
    `minirt.kernel.bvh_build`, also for the columns of boxes, (m, 8). They grow by a share, `margin`, of their
    coordinates.

    Returns the nodes of `minirt.kernel.bvh_nodes`, (n, NODE / WIDE, WIDE), the last of which are leaves, by group, as
    yet empty; for each leaf its boxes, (l, WIDE), the last one also in lanes to spare, and which lanes these are.
    """
    room = max(1, 2 * len(boxes) - 1)  # nodes of the tree, at most
    links, bounds, found = np.empty((room, 3), np.int64), np.empty((room, 6)), np.array([1, 0])
    tree = BinaryTree(boxes, bounds, links, found)
    links[0, :2], roots, most = (0, len(boxes)), np.zeros((1, 2), np.int64), len(boxes)
    while len(roots):
        most = most // PARTS if run and most >= PARALLEL * PARTS else 0
        job = bound(kernel.divide, np.zeros(1, np.int64), tree, roots, most)
        if run and len(roots) > 1:
            run(job)
        else:
            job()
        left = np.flatnonzero(links[: found[0], 2] < 0)  # nodes that `divide` has left, with -1 - level
        roots = np.stack([left, -1 - links[left, 2]], axis=1)
    children, references = np.empty((2, found[0] // 2 + 1, WIDE), np.int64)
    leaves, areas = np.empty(found[0], np.int64), np.empty((found[0], WIDE))
    kernel.collapse(tree, areas, np.empty((found[0], WIDE + 1), np.int8), children, references, leaves)
    node_count, leaf_count = found
    nodes = np.zeros((node_count + leaf_count, NODE // WIDE, WIDE), np.float32)
    children, references = children[:node_count], references[:node_count]
    with np.errstate(invalid="ignore"):  # an empty tree has a box of infinities
        nodes[:node_count, :6] = boxes_of(bounds, children, children < 0, margin)
    starts, stops = links[leaves[:leaf_count], :2].T
    order = np.argsort(boxes[starts, GROUP], kind="stable")
    numbers = np.empty(leaf_count, np.int64)
    numbers[order] = np.arange(node_count, node_count + leaf_count)
    is_leaf = references < 0
    references[is_leaf] = -numbers[-1 - references[is_leaf]]
    nodes[:node_count, 6] = references
    start, stop = starts[order, None], stops[order, None]
    inside = start + np.arange(WIDE)
    return nodes, np.minimum(inside, stop - 1), inside >= stop


def boxes_of(bounds: np.ndarray, places: np.ndarray, spare: np.ndarray, margin: float) -> np.ndarray:
    """Return the low x, y, z and high x, y, z of boxes, (n, 6, WIDE), by the places of their bounds, (n, WIDE); no ray
    hits those of lanes to `spare`."""
    boxes = np.ascontiguousarray(bounds[places].transpose(0, 2, 1))  # a tree takes 0.94 of the time
    sizes = np.abs(boxes)
    boxes += ROUNDING * sizes + margin * sizes.max(axis=1, keepdims=True)
    boxes[:, :3] *= -1.0
    boxes.transpose(0, 2, 1)[spare] = np.repeat([np.inf, -np.inf], 3)
    return boxes


def as_blocks(rows: np.ndarray, indices: np.ndarray) -> np.ndarray:
    """Gather the rows with some indices (n, WIDE) into n blocks."""
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
