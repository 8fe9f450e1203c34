"""Nodes of the trees of meshes.

The tree of a mesh is a wide bounding volume hierarchy in a space of its own, whose unit is half of the mesh's size: it
is built once for a file, and a mesh that is moved, turned or scaled keeps it. The triangles lie in the scene; leaves
have float32 copies of their corners, by which a ray is tested before it is intersected with a triangle itself.

Coherent rays traverse it together (`minirt.kernel.beam_traversal`), all others by themselves
(`minirt.kernel.mesh_single_rays`).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from minirt.lanes import width
from minirt.lanes.memory import prefetch

WIDE = width(np.empty(0, np.float32)) // 2  # children of a node
# Numbers of a node: the low x, y, z and high x, y, z of its children, or the corners of the triangles of a leaf; and
# references to them.
NODE = 10 * WIDE
HIGH, REFERENCES = 3 * WIDE, 9 * WIDE  # offsets in a node
LINE = 16  # float32 in a line of the processor's cache
ROUNDING = 2.0**-20  # of the space of a tree: rounding of boxes, and of their test
HUGE = 1e30  # more than any number of a box; a coordinate of triangles that no ray hits, in lanes to spare

CENTRE, FACTOR, APART = 9, 12, 13  # columns of `MeshTrees.places`


class MeshTrees(NamedTuple):
    """The trees of the k meshes of a scene.

    The reference to a node is its number in its tree, that to a leaf minus its number; the reference to triangle i is
    -1 - i. (float32 can count the triangles of the largest file, see `minirt.meshes.obj`.)
    """

    nodes: Any  # float32, flat, `NODE` numbers for each node of all trees
    starts: Any  # (k, 2) the number of the first node of each tree, and the index in the scene of its first triangle
    # (k, 14) from the scene to the space of a tree: a rotation by rows, the point that is subtracted before it, the
    # factor behind it; and how far from that point is the position of the mesh
    places: Any
    numbers: Any  # (rows,) the number of the mesh whose first triangle is in a row


def prefetch_node(nodes: Any, node: int) -> None:
    """Prefetch a node or a leaf."""
    for line in range(0, NODE, LINE):
        prefetch(nodes, node * NODE + line)
