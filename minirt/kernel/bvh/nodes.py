"""A tree of boxes for rays that share no origin, as many boxes in a node as there are lanes.

A ray is tested against all boxes of a node at once, each plane of them one load (Wald et al., Getting Rid of Packets,
2008). The tree is widened for what rounding may do to both the test of the boxes and the formulas of the shapes: a box
by `MARGIN` of its coordinates when it is built, and for each ray by `MARGIN` of the coordinates of its origin. That is
more than the roundings of the test itself (Ize, Robust BVH Ray Traversal, 2013).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.trace import COINCIDENT
from minirt.lanes import Vec, copysign, fabs, load, maximum, minimum, width
from minirt.lanes.largest import largest
from minirt.lanes.operations import Mask
from minirt.lanes.vec import Number

WIDTH = width(np.empty(0))  # children of a node, shapes in a leaf, rays in a packet
MARGIN = 2.0**-42  # of the coordinates; a formula is wrong by less than 2**-47 of distance, place and size together
TINY = 2.0**-500  # stands for 0 in a direction, so that no ray is parallel to the planes of boxes
NODE = 7 * WIDTH  # numbers of a node: of its children the low x, y and z, the high x, y and z, and the names
REFERENCES = 6 * WIDTH  # where those are
LEVELS = 32  # of the tree down to `WIDTH` shapes or fewer
REFERENCE_BITS = 0xFFFFFFFF  # the bits of a number that hold a name

# What a packet keeps on its way, in numbers of its memory: a row of lanes for each of x, y and z.
ENTER, LEAVE, INVERSE, ORIGIN, DIRECTION, HIT = (3 * WIDTH * i for i in range(6))  # beyond `HIT` nothing matters
NEXT = 18 * WIDTH  # the tag of the node or leaf that each ray visits next
TOP = 19 * WIDTH  # where the last of its rows in `STACK` is, a whole number
STACK = 20 * WIDTH  # for each level of the tree and each ray a row of tags, of the children that it has still to visit
STACK_LEVEL = WIDTH * WIDTH
MEMORY = STACK + (LEVELS + WIDTH) * STACK_LEVEL


class Group(NamedTuple):
    """The shapes of one kind. A leaf of the tree is a block of up to `WIDTH` of them, side by side."""

    rows: Any  # a row a shape
    blocks: Any  # for each number of a packed shape `WIDTH` of them; where there are fewer shapes, the last again
    labels: Any  # (blocks, WIDTH, 2) which shapes of the scene those are, and their extents
    unbounded: Any  # (k,) the shapes of the scene that are in no box


class Tree(NamedTuple):
    """The n shapes of a scene, sorted into boxes.

    The name of a node is where in `nodes` it begins; that of block b of group g is -1 - (b * groups + g).
    """

    nodes: Any  # flat, `NODE` numbers a node
    extents: Any  # (n,) largest coordinate of each shape
    slots: Any  # (n, 2) where each shape is: its group and its row there
    groups: Any  # a tuple of Group


def store_rays(memory: Any, origin: Vec, direction: Vec) -> None:
    """Keep the rays of a packet, as the boxes are tested with them."""
    inverse = Vec(safe_inverse(direction.x), safe_inverse(direction.y), safe_inverse(direction.z))
    slack = MARGIN * largest(origin)
    grow = Vec(copysign(slack, inverse.x), copysign(slack, inverse.y), copysign(slack, inverse.z))
    enter = origin + grow  # to move the ray forward is to move the planes that it enters by back
    leave = origin - grow
    # A plane is then one multiplication and subtraction away; what that rounds is less than the slack, too.
    put_vec(memory, ENTER, Vec(enter.x * inverse.x, enter.y * inverse.y, enter.z * inverse.z))
    put_vec(memory, LEAVE, Vec(leave.x * inverse.x, leave.y * inverse.y, leave.z * inverse.z))
    put_vec(memory, INVERSE, inverse)
    put_vec(memory, ORIGIN, origin)
    put_vec(memory, DIRECTION, direction)


def safe_inverse(x: Number) -> Number:
    """1 / x, and something large for 0, with the sign of that."""
    return 1.0 / copysign(maximum(fabs(x), TINY), x)


def put_vec(memory: Any, at: int, v: Vec) -> None:
    put(memory, at, v.x)
    put(memory, at + WIDTH, v.y)
    put(memory, at + 2 * WIDTH, v.z)


def vec_at(memory: Any, at: int, ray: int) -> Vec:
    """The vector of one ray."""
    return Vec(memory[at + ray], memory[at + WIDTH + ray], memory[at + 2 * WIDTH + ray])


def near_planes(inverse: Vec) -> tuple[int, int, int]:
    """Where in a node the planes are that a ray enters boxes by: the low ones along +0, the high ones along -0."""
    x = 0 if inverse.x > 0.0 else 3 * WIDTH
    y = WIDTH if inverse.y > 0.0 else 4 * WIDTH
    z = 2 * WIDTH if inverse.z > 0.0 else 5 * WIDTH
    return x, y, z


def intersect_boxes(
    nodes: Any, node: int, memory: Any, ray: int, planes: tuple[int, int, int], limit: float
) -> tuple[Mask, Number]:
    """Which boxes of a node a ray meets up to the distance `limit`, and where it enters them."""
    x, y, z = planes
    enter, leave, inverse = vec_at(memory, ENTER, ray), vec_at(memory, LEAVE, ray), vec_at(memory, INVERSE, ray)
    in_x = load(nodes, node + x) * inverse.x - enter.x
    in_y = load(nodes, node + y) * inverse.y - enter.y
    in_z = load(nodes, node + z) * inverse.z - enter.z
    out_x = load(nodes, node + 3 * WIDTH - x) * inverse.x - leave.x
    out_y = load(nodes, node + 5 * WIDTH - y) * inverse.y - leave.y
    out_z = load(nodes, node + 7 * WIDTH - z) * inverse.z - leave.z
    near = maximum(maximum(in_x, in_y), maximum(in_z, 0.0))
    far = minimum(minimum(out_x, out_y), minimum(out_z, limit))
    return near <= far, near


def search_limit(distance: float) -> float:
    """How far to look where all nearer than `distance`, or in the same place as it, counts."""
    return distance * (1.0 + 2.0 * COINCIDENT)


# A name travels with the distance to its box in one number: it takes the place of the low half of the bits, which
# changes the distance by less than 2**-20 of it. The order of such numbers is that of the distances.


def leaf_number(name: int) -> int:
    """The number of a leaf in its name."""
    return ~name & REFERENCE_BITS >> 1  # the compiler sees that it is not below 0


def tag(distance: Number, names: Number) -> Number:
    """Distances with names in their low bits."""
    return ((distance.view(np.int64) & ~REFERENCE_BITS) | names.view(np.int64)).view(np.float64)


def reference_of(tagged: float) -> int:
    """The name that is in a number."""
    return int(np.float64(tagged).view(np.int64).astype(np.int32))


def bits(mask: Mask) -> int:
    """A mask as a whole number, the bits of which are the truths, that of the first lane the lowest."""
    return sum(1 << int(ray) for ray in np.flatnonzero(mask))


def least_lane(x: Number) -> float:
    """The least of some numbers that are not below 0; NaN is more than infinity."""
    return float(x.view(np.int64).min().view(np.float64))


def packet_memory() -> Any:
    """Room for what a packet keeps on its way; compiled, it is a thread's own."""
    return np.zeros(MEMORY)


def integer_at(memory: Any, at: int) -> int:
    """A whole number that was kept."""
    return int(memory[at : at + 1].view(np.int64)[0])


def put_integer(memory: Any, at: int, n: int) -> None:
    """Keep a whole number, in the place of another one."""
    memory[at : at + 1].view(np.int64)[0] = n


def put(memory: Any, at: int, x: Number) -> None:
    """Keep a number a lane, from index `at` on."""
    memory[at : at + WIDTH] = x
