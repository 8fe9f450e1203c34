"""Nodes of the wide bounding volume hierarchies (BVH): of the tree of a scene, and of the trees of meshes.

One ray is tested against all children of a node at once (Wald et al., Getting Rid of Packets, 2008). A tree has a space
of its own, in which no coordinate is more than 1 or little more, so boxes are float32. That of a mesh is built once for
a file, and a mesh that is moved, turned or scaled keeps it.

Coherent rays traverse the tree of a mesh together (`minirt.kernel.beam_traversal`), and packets of rays that of a scene
(`minirt.kernel.bvh_traversal`); all others go by themselves through both (`minirt.kernel.bvh_single_rays`).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.scene_arrays import LEVELS
from minirt.lanes import Vec, width
from minirt.lanes.memory import prefetch

WIDTH = width(np.empty(0))  # rays in a packet
WIDE = width(np.empty(0, np.float32)) // 2  # children of a node, shapes or triangles in a leaf: as many
# Numbers of a node: the low x, y, z and high x, y, z of its children, and references to them; the rest is not used. A
# leaf has the boxes of its shapes; that of a mesh two corners of its triangles, references to these, and third corners.
NODE = 10 * WIDE
HIGH, REFERENCES, CORNERS = 3 * WIDE, 6 * WIDE, 7 * WIDE  # offsets in a node or leaf
DEEPEST = LEVELS + WIDE  # nodes from the root to a leaf, at most: the last levels part shapes by their kinds
LINE = 16  # float32 in a line of the processor's cache
MARGIN = 2.0**-42  # of the coordinates; formulas err by less than 2**-47 of distance, position and size together
ROUNDING = 2.0**-20  # of coordinates in the space of a tree: rounding of boxes, and of their test
HUGE = 1e30  # more than any number of a box; a coordinate of triangles that no ray hits, in lanes to spare

CENTRE, FACTOR, APART = 9, 12, 13  # columns of places, see `MeshTrees`

ORIGIN, DIRECTION, HIT = 0, 3 * WIDTH, 6 * WIDTH  # offsets in the memory of a packet: rows of lanes for x, y and z
MEMORY = 2 * WIDE * DEEPEST  # as much as building a tree takes


class LeafGroup(NamedTuple):
    """The shapes of one kind. A leaf of the tree is a block of up to `WIDE` shapes, in a structure of arrays."""

    rows: Any  # a row for each shape, or for each triangle of meshes
    # A block has `WIDE` lanes for each number of a packed shape, and for a mesh the row of its first triangle; lanes
    # to spare repeat the last shape.
    blocks: Any
    labels: Any  # (blocks, WIDE, 2) index in the scene and extent of the shape in each lane of a block
    unbounded: Any  # (k,) indices in the scene of shapes without a bounding box; None for a kind that is not infinite
    first_leaf: int  # the number of the leaf of the first block; those of the others follow it
    number: int  # of the group in `Tree.slots`; -1 without rows
    trees: Any = None  # of meshes: `MeshTrees`
    triangles: Any = None  # of meshes


class Tree(NamedTuple):
    """The BVH over the n shapes of a scene. Without nodes, it is the tree of a scene that needs none.

    The reference to a node is its number in its tree, that to a leaf minus its number.
    """

    nodes: Any  # float32, flat, `NODE` numbers for each node and, behind all nodes, each leaf
    place: Any  # (14,) its space, as a row of `MeshTrees.places`
    extents: Any  # (n,) largest coordinate of each shape, 0 for triangles of meshes
    slots: Any  # (n, 2) index of each shape's group, and of its row in that group
    groups: Any  # a tuple of LeafGroup


class MeshTrees(NamedTuple):
    """The trees of the k meshes of a scene, with references as in `Tree`; that to triangle i is -1 - i. (float32 can
    count the triangles of the largest file, see `minirt.meshes.obj`.)"""

    nodes: Any  # as of a `Tree`, those of all trees
    starts: Any  # (k, 2) the number of the first node of each tree, and the index in the scene of its first triangle
    # (k, 14) from the scene to the space of a tree: a rotation by rows, the point that is subtracted before it, the
    # factor behind it; and how far from that point is the position of the mesh
    places: Any
    numbers: Any  # (rows,) the number of the mesh whose first triangle is in a row


def prefetch_node(nodes: Any, node: int, reads_leaves: int) -> None:
    """Prefetch a node, or all of a leaf."""
    for line in range(0, CORNERS, LINE):
        prefetch(nodes, node * NODE + line)
    if reads_leaves != 0:
        for line in range(CORNERS, NODE, LINE):
            prefetch(nodes, node * NODE + line)


def packet_memory() -> Any:
    """Allocate the memory of a packet; compiled, it lies on the stack of the thread."""
    return np.zeros(MEMORY)


def vec_at(memory: Any, at: int, ray: int) -> Vec:
    """Return the vector of one ray, from three rows of lanes from index `at` on."""
    return Vec(memory[at + ray], memory[at + WIDTH + ray], memory[at + 2 * WIDTH + ray])
