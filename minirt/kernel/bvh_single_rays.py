"""BVH traversal by single rays, each of which meets all children of a node, or all shapes of a leaf, at a time.

Rays advance together, one step of each in turn. A step waits for memory and for pipelines, and a mispredicted branch
costs all work that the processor began behind it. Steps of different rays do not wait for each other. So the rays are
interleaved, and a step has no branch: in its place is a mask with one bit for each ray, and the nearest child is found
among all lanes at once, not by sorting.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

from minirt.kernel.bvh_nodes import (
    GROUPS,
    HIT,
    INVERSE,
    LINE,
    NEXT,
    NODE,
    REFERENCES,
    STACK,
    STACK_LEVEL,
    TOP,
    WIDTH,
    LeafGroup,
    Tree,
    integer_at,
    intersect_boxes,
    leaf_number,
    least_lane,
    near_planes,
    put_integer,
    reference_of,
    search_limit,
    tag,
    vec_at,
)
from minirt.kernel.scene_arrays import has_rows
from minirt.kernel.trace import for_each_kind
from minirt.lanes import any, load, lowest, outlined, save, where
from minirt.lanes.memory import prefetch


@outlined
def traverse(visit: Callable[..., None], tree: Tree, memory: Any, rays: int, start: float) -> None:
    """Call `visit(group, block, tree, memory, ray)` for the leaves that each of the `rays` hits, the nearest first.

    `rays` has one bit for each ray. They begin at the node or leaf with the tagged distance `start`. Leaves beyond the
    distance in the first row of `HIT`, which `visit` may lessen, are skipped.
    """
    remaining = rays
    while remaining != 0:
        ray = lowest(remaining)
        remaining = remaining & (remaining - 1)
        memory[NEXT + ray] = start
        put_integer(memory, TOP + ray, STACK - STACK_LEVEL + ray * WIDTH)
    at_node, at_leaf = (rays, 0) if reference_of(start) >= 0 else (0, rays)
    unfinished = 0
    while True:
        for_each_kind(visit_leaves_of_kind, tree.groups, at_leaf, (visit, tree, memory))
        remaining = at_node
        while remaining != 0:
            ray = lowest(remaining)
            remaining = remaining & (remaining - 1)
            unfinished = unfinished | descend(tree.nodes, memory, ray) << ray
        if unfinished == 0:
            return
        at_node, at_leaf = 0, 0
        remaining = unfinished
        while remaining != 0:
            ray = lowest(remaining)
            remaining = remaining & (remaining - 1)
            node, leaf, last = advance(tree.nodes, memory, ray)
            at_node = at_node | node << ray
            at_leaf = at_leaf | leaf << ray
            unfinished = unfinished ^ last << ray


def descend(nodes: Any, memory: Any, ray: int) -> int:
    """Push the children of the next node whose boxes a ray hits onto its stack; returns 1 if there are any, else 0."""
    node = reference_of(memory[NEXT + ray])
    planes = near_planes(vec_at(memory, INVERSE, ray))
    hit, near = intersect_boxes(nodes, node, memory, ray, planes, search_limit(memory[HIT + ray]))
    top = integer_at(memory, TOP + ray) + STACK_LEVEL
    save(where(hit, tag(near, load(nodes, node + REFERENCES)), inf), memory, top)
    pushed = int(any(hit))
    put_integer(memory, TOP + ray, top - STACK_LEVEL * (1 - pushed))
    return pushed


def advance(nodes: Any, memory: Any, ray: int) -> tuple[int, int, int]:
    """Pop the nearest child from the top row of a ray's stack, and make it the next to visit.

    Distances in rows are tagged with references, see `minirt.kernel.bvh_nodes`; a row in which nothing else is within
    reach is dropped.

    Returns three flags, 1 or 0: whether the child is a node to visit, whether it is a leaf to visit, and whether the
    stack is now empty.
    """
    limit = search_limit(memory[HIT + ray])
    top = integer_at(memory, TOP + ray)
    tags = load(memory, top)
    nearest = least_lane(tags)
    others = where(tags == nearest, inf, tags)
    save(others, memory, top)
    top = top - STACK_LEVEL * (1 - int(any(others < limit)))
    put_integer(memory, TOP + ray, top)
    memory[NEXT + ray] = nearest
    in_reach = nearest < limit
    reference = reference_of(nearest)
    is_node = reference >= 0
    for line in range(0, NODE, LINE):
        prefetch(nodes, max(reference, 0) + line)
    return int(in_reach & is_node), int(in_reach & (not is_node)), int(top < STACK)


def visit_leaves_of_kind(group: LeafGroup, rays: int, arguments: tuple[Callable[..., None], Tree, Any]) -> int:
    """Visit the leaves of one kind of shape that the `rays` are at, one bit for each; the state is not changed."""
    visit, tree, memory = arguments
    remaining = rays if has_rows(group.blocks) else 0
    while remaining != 0:
        ray = lowest(remaining)
        remaining = remaining & (remaining - 1)
        leaf = leaf_number(reference_of(memory[NEXT + ray]))
        if leaf % GROUPS == group.number:
            visit(group, leaf // GROUPS, tree, memory, ray)
    return rays
