"""Nodes of a wide bounding volume hierarchy (BVH), with as many children in a node as there are SIMD lanes.

One ray is tested against all child boxes of a node at once, each plane of them one load (Wald et al., Getting Rid of
Packets, 2008). Boxes are widened for the rounding of both the box test and the formulas of the shapes: by `MARGIN` of
their coordinates when they are built, and for each ray by `MARGIN` of the coordinates of its origin. That is more than
the rounding of the test itself (Ize, Robust BVH Ray Traversal, 2013).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.scene_arrays import LEVELS
from minirt.kernel.trace import COINCIDENT
from minirt.lanes import Mask, Number, Vec, copysign, load, load_vec, max_norm, maximum, minimum, save_vec, where, width

WIDTH = width(np.empty(0))  # children of a node, shapes in a leaf, rays in a packet
MARGIN = 2.0**-42  # of the coordinates; formulas err by less than 2**-47 of distance, position and size together
TINY = 2.0**-500  # replaces 0 in a direction, so that no ray is parallel to the planes of boxes
NODE = 7 * WIDTH  # numbers in a node: the low x, y, z and high x, y, z of its children, and references to them
REFERENCES = 6 * WIDTH  # offset of the references in a node
LINE = 8  # float64 in a line of the processor's cache
GROUPS = 32  # groups that references to leaves can tell apart: more than there are kinds
REFERENCE_BITS = 0xFFFFFFFF  # the bits of a float64 that hold a reference

# Offsets in the memory of a packet. The first six have a row of lanes for each of x, y and z.
ENTER, LEAVE, INVERSE, ORIGIN, DIRECTION, HIT = (3 * WIDTH * i for i in range(6))  # boxes beyond `HIT` are skipped
NEXT = 18 * WIDTH  # the tagged distance of the node or leaf that each ray visits next
TOP = 19 * WIDTH  # for each ray the offset of the top row of its stack, an integer
STACK = 20 * WIDTH  # for each level of the tree and each ray a row: the tagged distances of children still to visit
STACK_LEVEL = WIDTH * WIDTH  # numbers of one level of the stacks of all rays
# For each level of the tree, of what the packet as a whole has still to visit: tagged distances, and which rays hit it.
PACKET = STACK + (LEVELS + WIDTH) * STACK_LEVEL
PACKET_LEVEL = 2 * WIDTH
MEMORY = PACKET + (LEVELS + WIDTH) * PACKET_LEVEL


class LeafGroup(NamedTuple):
    """The shapes of one kind. A leaf of the tree is a block of up to `WIDTH` shapes, in a structure of arrays."""

    rows: Any  # a row for each shape, or for each triangle of meshes
    # A block has `WIDTH` lanes for each number of a packed shape, and for a mesh the row of its first triangle; lanes
    # to spare repeat the last shape.
    blocks: Any
    labels: Any  # (blocks, WIDTH, 2) index in the scene and extent of the shape in each lane of a block
    boxes: Any  # flat, for each block the low x, y, z and high x, y, z of its shapes; infinite in lanes to spare
    unbounded: Any  # (k,) indices in the scene of shapes without a bounding box; None for a kind that is not infinite
    number: int  # of the group in `Tree.slots`; -1 without rows
    trees: Any = None  # of meshes: `minirt.kernel.mesh_nodes.MeshTrees`
    triangles: Any = None  # of meshes


class Tree(NamedTuple):
    """The BVH over the n shapes of a scene.

    The reference to a node is its offset in `nodes`; the reference to leaf block b of group g is -1 - (b * GROUPS + g).
    Without nodes, it is the tree of a scene that needs none.
    """

    nodes: Any  # flat, `NODE` numbers for each node
    extents: Any  # (n,) largest coordinate of each shape, 0 for triangles of meshes
    slots: Any  # (n, 2) index of each shape's group, and of its row in that group
    groups: Any  # a tuple of LeafGroup


def store_rays(memory: Any, origin: Vec, direction: Vec) -> None:
    """Store the rays of a packet in its memory, prepared for the box test."""
    inverse = Vec(safe_inverse(direction.x), safe_inverse(direction.y), safe_inverse(direction.z))
    slack = MARGIN * max_norm(origin)
    grow = Vec(copysign(slack, inverse.x), copysign(slack, inverse.y), copysign(slack, inverse.z))
    enter = origin + grow  # moving the ray forward moves the planes by which it enters boxes back
    leave = origin - grow
    # The distance to a plane is then one multiplication and subtraction, whose rounding is less than the slack too.
    save_vec(Vec(enter.x * inverse.x, enter.y * inverse.y, enter.z * inverse.z), memory, ENTER)
    save_vec(Vec(leave.x * inverse.x, leave.y * inverse.y, leave.z * inverse.z), memory, LEAVE)
    save_vec(inverse, memory, INVERSE)
    save_vec(origin, memory, ORIGIN)
    save_vec(direction, memory, DIRECTION)


def safe_inverse(x: Number) -> Number:
    """Return 1 / x, or a huge number with the sign of x for x = 0 and -0."""
    return 1.0 / where((x > TINY) | (x < -TINY), x, copysign(TINY, x))


def vec_at(memory: Any, at: int, ray: int) -> Vec:
    """Return the vector of one ray, from three rows of lanes from index `at` on."""
    return Vec(memory[at + ray], memory[at + WIDTH + ray], memory[at + 2 * WIDTH + ray])


def near_planes(inverse: Vec) -> tuple[int, int, int]:
    """Return the offsets in a node of the planes by which a ray enters boxes: low ones along +0, high ones along -0."""
    x = 0 if inverse.x > 0.0 else 3 * WIDTH
    y = WIDTH if inverse.y > 0.0 else 4 * WIDTH
    z = 2 * WIDTH if inverse.z > 0.0 else 5 * WIDTH
    return x, y, z


def intersect_boxes(
    nodes: Any, node: int, memory: Any, ray: int, planes: tuple[int, int, int], limit: float
) -> tuple[Mask, Number]:
    """Return the boxes of a node that a ray hits up to `limit`, and its entry distances."""
    x, y, z = planes
    enter, leave, inverse = vec_at(memory, ENTER, ray), vec_at(memory, LEAVE, ray), vec_at(memory, INVERSE, ray)
    near = Vec(load(nodes, node + x), load(nodes, node + y), load(nodes, node + z))
    far = Vec(load(nodes, node + 3 * WIDTH - x), load(nodes, node + 5 * WIDTH - y), load(nodes, node + 7 * WIDTH - z))
    return slab_test(near, far, enter, leave, inverse, limit)


def rays_in_box(boxes: Any, at: int, memory: Any, limit: Number) -> tuple[Mask, Number]:
    """Return the rays of a packet that hit one box up to `limit`, and their entry distances.

    Its bounds are `WIDTH` numbers apart, the first one at index `at`.
    """
    enter, leave, inverse = load_vec(memory, ENTER), load_vec(memory, LEAVE), load_vec(memory, INVERSE)
    x, y, z = inverse.x > 0.0, inverse.y > 0.0, inverse.z > 0.0
    low = Vec(boxes[at], boxes[at + WIDTH], boxes[at + 2 * WIDTH])
    high = Vec(boxes[at + 3 * WIDTH], boxes[at + 4 * WIDTH], boxes[at + 5 * WIDTH])
    near = Vec(where(x, low.x, high.x), where(y, low.y, high.y), where(z, low.z, high.z))
    far = Vec(where(x, high.x, low.x), where(y, high.y, low.y), where(z, high.z, low.z))
    return slab_test(near, far, enter, leave, inverse, limit)


def slab_test(near: Vec, far: Vec, enter: Vec, leave: Vec, inverse: Vec, limit: Number) -> tuple[Mask, Number]:
    """Slab test (Kay and Kajiya 1986): whether rays hit boxes up to `limit`, and the distances at which they enter."""
    in_x, in_y, in_z = near.x * inverse.x - enter.x, near.y * inverse.y - enter.y, near.z * inverse.z - enter.z
    out_x, out_y, out_z = far.x * inverse.x - leave.x, far.y * inverse.y - leave.y, far.z * inverse.z - leave.z
    begin = maximum(maximum(in_x, in_y), maximum(in_z, 0.0))
    end = minimum(minimum(out_x, out_y), minimum(out_z, limit))
    return begin <= end, begin


def search_limit(distance: Number) -> Number:
    """Return how far to search for hits nearer than `distance` or coincident with a hit there."""
    return distance * (1.0 + 2.0 * COINCIDENT)


# Tagged distances: a reference replaces the low half of the bits of the entry distance of its box, which changes the
# distance by less than 2**-20 of it. Tagged distances sort in the order of the distances.


def leaf_number(reference: int) -> int:
    """Return the number of a leaf, b * GROUPS + g, from the reference to it."""
    return ~reference & REFERENCE_BITS >> 1  # so that the compiler knows that it is not negative


def tag(distance: Number, references: Number) -> Number:
    """Put references into the low bits of distances."""
    return ((distance.view(np.int64) & ~REFERENCE_BITS) | references.view(np.int64)).view(np.float64)


def reference_of(tagged: float) -> int:
    """Return the reference in the low bits of a tagged distance."""
    return int(np.float64(tagged).view(np.int64).astype(np.int32))


def least_lane(x: Number) -> float:
    """Return the least of the lanes, none of which is NaN."""
    return float(x.min())


def packet_memory() -> Any:
    """Allocate the memory of a packet for traversal; compiled, it lies on the stack of the thread."""
    return np.zeros(MEMORY)


def put_integer(memory: Any, at: int, n: int) -> None:
    """Store an integer in the packet's memory, in the place of a float64."""
    memory[at : at + 1].view(np.int64)[0] = n


def integer_at(memory: Any, at: int) -> int:
    """Return the integer that `put_integer` stored: the low bits of a float64, as references are, too."""
    return reference_of(memory[at])
