"""A tree of boxes for rays that share no origin, as many boxes in a node as there are lanes.

A ray is tested against all boxes of a node at once, each plane of them one load (Wald et al., Getting Rid of Packets,
2008). The tree is widened for what rounding may do to both the test of the boxes and the formulas of the shapes: a box
by `MARGIN` of its coordinates when it is built, and for each ray by `MARGIN` of the coordinates of its origin. That is
more than the 3 roundings of the test itself (Ize, Robust BVH Ray Traversal, 2013).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.trace import NEARBY, over_kinds
from minirt.lanes import Vec, copysign, load, lowest, maximum, minimum, width
from minirt.lanes.largest import largest
from minirt.lanes.vec import Number
from minirt.lanes.verbs import Mask

WIDTH = width(np.empty(0))  # children of a node, shapes in a leaf, rays in a packet
MARGIN = 2.0**-42  # of the coordinates; a formula is wrong by less than 2**-47 of distance, place and size together
NODE = 7 * WIDTH  # numbers of a node: of its children the low x, y and z, the high x, y and z, and the names
LEVELS = 32  # of the tree down to `WIDTH` shapes or fewer
NAME = 0xFFFFFFFF  # the bits of a number that hold a name

# What a packet keeps on its way, in numbers of its memory: a row of lanes for each of x, y and z.
ENTER, LEAVE, INVERSE, ORIGIN, DIRECTION, FOUND = (3 * WIDTH * i for i in range(6))
TAGS = 18 * WIDTH  # of the children of a node
TODO = 19 * WIDTH  # nodes and leaves that a ray has still to visit
MEMORY = TODO + (LEVELS + WIDTH) * (WIDTH - 1)


class Group(NamedTuple):
    """The shapes of one kind. A leaf of the tree is a block of up to `WIDTH` of them, side by side."""

    rows: Any  # a row a shape
    blocks: Any  # for each number of a packed shape `WIDTH` of them; where there are fewer shapes, the last again
    owners: Any  # (blocks, WIDTH) which shapes of the scene those are
    endless: Any  # (k,) the shapes of the scene that are in no box


class Tree(NamedTuple):
    """The n shapes of a scene, sorted into boxes.

    The name of a node is where in `nodes` it begins; that of block b of group g is -1 - (b * groups + g).
    """

    nodes: Any  # flat, `NODE` numbers a node
    extents: Any  # (n,) largest coordinate of each shape
    places: Any  # (n, 2) where each shape is: its group and its row there
    groups: Any  # a tuple of Group


def aim(memory: Any, origin: Vec, direction: Vec) -> None:
    """Keep the rays of a packet, as the boxes are tested with them."""
    inverse = Vec(1.0 / direction.x, 1.0 / direction.y, 1.0 / direction.z)
    slack = MARGIN * largest(origin)
    grow = Vec(copysign(slack, inverse.x), copysign(slack, inverse.y), copysign(slack, inverse.z))
    put_vec(memory, ENTER, origin + grow)  # to move the ray forward is to move the planes that it enters by back
    put_vec(memory, LEAVE, origin - grow)
    put_vec(memory, INVERSE, inverse)
    put_vec(memory, ORIGIN, origin)
    put_vec(memory, DIRECTION, direction)


def put_vec(memory: Any, at: int, v: Vec) -> None:
    put(memory, at, v.x)
    put(memory, at + WIDTH, v.y)
    put(memory, at + 2 * WIDTH, v.z)


def vec_at(memory: Any, at: int, ray: int) -> Vec:
    """The vector of one ray."""
    return Vec(memory[at + ray], memory[at + WIDTH + ray], memory[at + 2 * WIDTH + ray])


def planes_of(inverse: Vec) -> tuple[int, int, int]:
    """Where in a node the planes are that a ray enters boxes by: the low ones along +0, the high ones along -0."""
    x = 0 if inverse.x > 0.0 else 3 * WIDTH
    y = WIDTH if inverse.y > 0.0 else 4 * WIDTH
    z = 2 * WIDTH if inverse.z > 0.0 else 5 * WIDTH
    return x, y, z


def boxes_met(
    nodes: Any, node: int, memory: Any, ray: int, planes: tuple[int, int, int], limit: float
) -> tuple[Mask, Number]:
    """Which boxes of a node a ray meets up to the distance `limit`, and where it enters them."""
    x, y, z = planes
    enter, leave, inverse = vec_at(memory, ENTER, ray), vec_at(memory, LEAVE, ray), vec_at(memory, INVERSE, ray)
    in_x = (load(nodes, node + x) - enter.x) * inverse.x
    in_y = (load(nodes, node + y) - enter.y) * inverse.y
    in_z = (load(nodes, node + z) - enter.z) * inverse.z
    out_x = (load(nodes, node + 3 * WIDTH - x) - leave.x) * inverse.x
    out_y = (load(nodes, node + 5 * WIDTH - y) - leave.y) * inverse.y
    out_z = (load(nodes, node + 7 * WIDTH - z) - leave.z) * inverse.z
    # 0 * inf is NaN where a ray runs in a side of the widened box, and hits nothing in it. A distance is no NaN: the
    # verbs take their second argument instead.
    near = maximum(maximum(in_x, in_y), maximum(in_z, 0.0))
    far = minimum(minimum(out_x, out_y), minimum(out_z, limit))
    return near <= far, near


def walk(visit: Callable[..., Any], tree: Tree, memory: Any, ray: int, state: Any) -> Any:
    """The state after `state = visit(group, block, tree, origin, direction, state)` for the leaves that a ray meets,
    the nearest first. The first of the state is a distance beyond which nothing matters.
    """
    origin, direction = vec_at(memory, ORIGIN, ray), vec_at(memory, DIRECTION, ray)
    planes = planes_of(vec_at(memory, INVERSE, ray))
    limit = reach(state[0])
    left = TODO
    name = 0
    while True:
        if name >= 0:
            met, near = boxes_met(tree.nodes, name, memory, ray, planes, limit)
            children = bits(met)
            if children != 0:
                child = lowest(children)
                children = children & (children - 1)
                if children == 0:
                    name = name_of(tree.nodes[name + 6 * WIDTH + child])
                    continue
                # The nearest is visited next. The others wait, sorted so that the nearer is last.
                put(memory, TAGS, tag(near, load(tree.nodes, name + 6 * WIDTH)))
                next_tag = memory[TAGS + child]
                start = left
                while children != 0:
                    other = memory[TAGS + lowest(children)]
                    children = children & (children - 1)
                    left = wait(memory, start, left, maximum(next_tag, other))
                    next_tag = minimum(next_tag, other)
                name = name_of(next_tag)
                continue
        else:
            state, _ = over_kinds(leaf_of_kind, tree.groups, (state, 0), (visit, -1 - name, tree, origin, direction))
            limit = reach(state[0])
        while left > TODO and memory[left - 1] > limit:
            left -= 1
        if left == TODO:
            return state
        left -= 1
        name = name_of(memory[left])


def reach(distance: float) -> float:
    """How far to look where all nearer than `distance`, or in the same place as it, counts."""
    return distance * (1.0 + 2.0 * NEARBY)


def wait(memory: Any, start: int, left: int, tagged: float) -> int:
    """Put a tag among those from `start` to `left`, which fall, and return their end."""
    at = left
    while at > start and memory[at - 1] < tagged:
        memory[at] = memory[at - 1]
        at -= 1
    memory[at] = tagged
    return left + 1


def leaf_of_kind(group: Group, state: tuple[Any, int], given: tuple[Callable[..., Any], int, Tree, Vec, Vec]) -> Any:
    """`visit` of a leaf, if it is one of this kind; the last of the state counts the kinds."""
    inner, number = state
    visit, leaf, tree, origin, direction = given
    if leaf % len(tree.groups) == number:
        inner = visit(group, leaf // len(tree.groups), tree, origin, direction, inner)
    return inner, number + 1


# A name travels with the distance to its box in one number: it takes the place of the low half of the bits, which
# changes the distance by less than 2**-20 of it. The order of such numbers is that of the distances.


def tag(distance: Number, names: Number) -> Number:
    """Distances with names in their low bits."""
    return ((distance.view(np.int64) & ~NAME) | names.view(np.int64)).view(np.float64)


def name_of(tagged: float) -> int:
    """The name that is in a number."""
    return int(np.float64(tagged).view(np.int64).astype(np.int32))


def bits(mask: Mask) -> int:
    """A mask as a whole number, the bits of which are the truths, that of the first lane the lowest."""
    return sum(1 << int(ray) for ray in np.flatnonzero(mask))


def packet_memory() -> Any:
    """Room for what a packet keeps on its way; compiled, it is a thread's own."""
    return np.zeros(MEMORY)


def put(memory: Any, at: int, x: Number) -> None:
    """Keep a number a lane, from index `at` on."""
    memory[at : at + WIDTH] = x
