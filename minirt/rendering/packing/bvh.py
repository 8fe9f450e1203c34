"""Builds the BVH of a scene: bounding boxes, SAH (Wald 2007), wide nodes, and blocks of shapes as its leaves; and the
trees of meshes, each once for its file."""

from __future__ import annotations

from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from minirt.kernel import beams
from minirt.kernel.bvh_build import BINS, GROUP, INDEX, BinaryTree
from minirt.kernel.bvh_nodes import GROUPS, MARGIN, NODE, REFERENCES, WIDTH, Group, Tree
from minirt.kernel.scene_arrays import kind_of, row_type
from minirt.meshes import Triangles
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.shapes import Kind
from minirt.shapes.mesh import Mesh

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
        spare = start + np.arange(WIDTH) >= stop
        leaf_boxes = boxes_of(boxes[np.minimum(start + np.arange(WIDTH), stop - 1), :6], spare)
        unbounded = infinite[shape_arrays.slots[infinite, 0] == group] if kinds_are_infinite[group] else None
        groups.append(Group(rows, group_blocks, labels, leaf_boxes, unbounded, group))
    names = nodes.reshape(-1, 7, WIDTH)[:, 6]
    is_leaf = names < 0
    leaf = (-1 - names[is_leaf]).astype(np.int64)
    names[is_leaf] = -1 - (blocks[leaf] * GROUPS + kinds[leaf])
    names[names == 0] = NO_LEAF
    names[...] = names.astype(np.int32).view(np.uint32).astype(np.uint64).view(np.float64)
    return Tree(nodes, extents, shape_arrays.slots, tuple(groups))


def boxes_of(bounds: np.ndarray, spare: np.ndarray) -> np.ndarray:
    """Return the boxes of the shapes of blocks, from their bounds (n, WIDTH, 6), as `write_child` writes them."""
    grown = bounds + MARGIN * np.abs(bounds).max(axis=2, initial=0.0)[..., None]
    grown[..., :3] *= -1.0
    grown[spare] = np.repeat([np.inf, -np.inf], 3)
    flat = aligned(grown.size, np.dtype(np.float64))
    flat[...] = grown.transpose(0, 2, 1).ravel()
    return flat


def without_boxes(tree: Tree) -> Tree:
    """Widen all boxes of a BVH to all of space, so that each ray visits every leaf."""
    groups = tuple(group._replace(boxes=widened(group.boxes, REFERENCES)) for group in tree.groups)
    return tree._replace(nodes=widened(tree.nodes, NODE), groups=groups)


def widened(nodes: np.ndarray, size: int) -> np.ndarray:
    """Return nodes of so many numbers with all of space as the boxes of their children."""
    nodes = nodes.copy()
    low, high = np.split(nodes.reshape(-1, size)[:, :REFERENCES], 2, axis=1)
    used = low <= high  # an unused child has an empty box
    low[used], high[used] = -np.inf, np.inf
    return nodes


def wide_nodes(boxes: np.ndarray, kernel: Any, width: int = WIDTH) -> tuple[np.ndarray, np.ndarray]:
    """Build a binary tree over boxes, sorting them, and collapse it into nodes of some width; see
    `minirt.kernel.bvh_build`.

    Returns the nodes, and for each leaf its first box and the box behind its last.
    """
    most = max(1, 2 * len(boxes) - 1)
    links, bounds = np.empty((most, 3), np.int64), np.empty((most, 6))
    stack = np.empty((most + 1, 2), np.int64)
    found, scratch = np.empty(2, np.int64), (np.empty((BINS + 1, 7)), np.empty(BINS), np.empty(6), stack)
    tree = BinaryTree(boxes, bounds, links, *scratch, found, width)
    kernel.divide(tree)
    count = int(found[0])
    tree = tree._replace(bounds=bounds[:count], links=links[:count])
    nodes = aligned((count // 2 + 1) * 7 * width, np.dtype(np.float64))
    leaves = np.empty(count, np.int64)
    kernel.collapse(tree, nodes, leaves, np.empty(width, np.int64))
    node_count, leaf_count = found
    return nodes[: node_count * 7 * width], links[leaves[:leaf_count]]


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


# Trees of meshes.


trees: WeakKeyDictionary[Triangles, np.ndarray] = WeakKeyDictionary()  # float32 nodes


def pack_trees(shapes: ShapeArrays, kernel: Any) -> list[beams.MeshTrees | None]:
    """Return for each kind of shape of a scene the trees of its meshes, or None for a kind that is no mesh."""
    return [mesh_trees(shapes, kernel) if kind is Mesh else None for kind in shapes.group_numbers]


def mesh_trees(shapes: ShapeArrays, kernel: Any) -> beams.MeshTrees:
    """Return the trees of the meshes of a scene, built with the functions of `kernel` where they are not yet."""
    owners = [index for index, shape in enumerate(shapes.shapes) if isinstance(shape, Mesh)]
    meshes: Any = [shapes.shapes[index] for index in owners]
    nodes = [tree_of(mesh.triangles, kernel) for mesh in meshes]
    roots = np.cumsum([0, *map(len, nodes[:-1])]) // beams.NODE
    first = shapes.first_primitive[owners]
    rows = shapes.slots[first, 1]
    numbers = np.zeros(rows[-1] + 1, np.int64)
    numbers[rows] = np.arange(len(rows))
    joined = np.concatenate(nodes) if len(nodes) > 1 else nodes[0]
    return beams.MeshTrees(joined, np.stack([roots, first], axis=1), np.array(list(map(place_of, meshes))), numbers)


def place_of(mesh: Mesh) -> np.ndarray:
    """Return a row of `minirt.kernel.beams.MeshTrees.places`."""
    middle, size = space_of(mesh.triangles)
    (centre,) = mesh.placed(middle[None])
    apart = np.abs(centre - mesh.position).max()
    return np.array([*mesh.turned(np.eye(3)).ravel(), *centre, 1.0 / (size * mesh.scale), apart])


def space_of(triangles: Triangles) -> tuple[np.ndarray, float]:
    """Return what is the origin of a tree's space in the mesh's file, and what is 1 there."""
    low, high = triangles.box
    return (low + high) / 2, float((high - low).max() / 2)


def tree_of(triangles: Triangles, kernel: Any) -> np.ndarray:
    """Return the nodes of the tree of a mesh, which is built at the first call."""
    if triangles not in trees:
        middle, size = space_of(triangles)
        points = ((triangles.points - middle) / size)[triangles.corners]
        boxes = np.zeros((len(points), 8))
        np.negative(points.min(axis=1), out=boxes[:, :3])
        points.max(axis=1, out=boxes[:, 3:6])
        boxes[:, INDEX] = np.arange(len(points))
        del points  # a million triangles have 72 MB of them
        nodes, leaves = wide_nodes(boxes, kernel, beams.WIDE)
        inner = nodes.reshape(-1, 7, beams.WIDE)
        names = inner[:, 6]
        names[...] = np.where(names < 0, len(inner) - 1 - names, names / beams.NODE)
        trees[triangles] = np.concatenate([inner, leaf_nodes(boxes, leaves)], dtype=np.float32).ravel()
    return trees[triangles]


def leaf_nodes(boxes: np.ndarray, leaves: np.ndarray) -> np.ndarray:
    """Return nodes (n, 7, WIDE) of a mesh's tree whose children are the boxes of its leaves."""
    start, stop = leaves[:, :2, None].transpose(1, 0, 2)
    members = start + np.arange(beams.WIDE)
    boxes = boxes[:, : INDEX + 1].astype(np.float32)
    nodes: np.ndarray = boxes[np.minimum(members, stop - 1)].transpose(0, 2, 1)
    nodes[:, :3] *= -1
    nodes[:, INDEX] = -1 - nodes[:, INDEX]
    for plane in range(INDEX):
        nodes[:, plane][members >= stop] = np.inf if plane < 3 else -np.inf
    return nodes
