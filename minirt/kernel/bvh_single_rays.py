"""Traversal of trees by single rays, each of which meets all children of a node at a time.

Rays advance together, one step of each in turn. A step waits for memory and for pipelines, and a mispredicted branch
costs all work that the processor began behind it. Steps of different rays do not wait for each other. So the rays are
interleaved, and a step has no branch: in its place is a mask with one bit for each ray, and the nearest child is found
among all lanes at once, not by sorting. What a ray visits next is prefetched while the other rays are served.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

import numpy as np

from minirt.kernel.bvh_nodes import DEEPEST, NODE, REFERENCES, WIDE, prefetch_node
from minirt.kernel.bvh_rays import LEVEL, LIMIT, NEXT, PENDING, STACK, TOP, RayPacket, boxes_on_ray
from minirt.lanes import any, bits, first, lowest, outlined, save, where
from minirt.lanes.memory import load_half


@outlined
def traverse(
    prepare: Callable[..., int], visit: Callable[..., None], data: Any, rays: RayPacket, chosen: int, start: int
) -> None:
    """Call `visit(rays, at_leaf, data)` for the leaves that the `chosen` rays hit, the nearest first.

    `chosen` and `at_leaf` have one bit for each ray; `NEXT` has the leaf at which a ray is. All begin at the node or
    leaf with the reference `start`. Leaves beyond `LIMIT`, which `visit` may lessen, are skipped. Before, and while
    there is time to prefetch something, `prepare` with the same arguments returns which of the rays visit their leaf.
    """
    remaining = chosen
    while remaining != 0:
        ray = lowest(remaining)
        remaining = remaining & (remaining - 1)
        rays.integers[NEXT + ray], rays.integers[TOP + ray] = start, ray * DEEPEST - 1
    at_node, at_leaf = (chosen, 0) if start >= 0 else (0, chosen)
    unfinished = 0
    while True:
        at_leaf = prepare(rays, at_leaf, data)
        remaining = at_node
        while remaining != 0:
            ray = lowest(remaining)
            remaining = remaining & (remaining - 1)
            unfinished = unfinished | descend(rays, ray) << ray
        visit(rays, at_leaf, data)
        if unfinished == 0:
            return
        at_node, at_leaf = 0, 0
        remaining = unfinished
        while remaining != 0:
            ray = lowest(remaining)
            remaining = remaining & (remaining - 1)
            is_node, is_leaf, is_last = advance(rays, ray)
            at_node = at_node | is_node << ray
            at_leaf = at_leaf | is_leaf << ray
            unfinished = unfinished ^ is_last << ray


def descend(rays: RayPacket, ray: int) -> int:
    """Push the children of the next node whose boxes a ray hits onto its stack; returns 1 if the stack has any."""
    node, top = rays.root + rays.integers[NEXT + ray], rays.integers[TOP + ray] + 1
    hit, near = boxes_on_ray(rays, node, ray)
    save(near, rays.numbers, STACK + top * LEVEL)
    save(load_half(rays.nodes, node * NODE + REFERENCES), rays.numbers, STACK + top * LEVEL + WIDE)
    rays.integers[PENDING + top] = bits(hit)
    top = top - 1 + int(any(hit))
    rays.integers[TOP + ray] = top
    return int(top >= ray * DEEPEST)


def advance(rays: RayPacket, ray: int) -> tuple[int, int, int]:
    """Pop the nearest child from the top level of a ray's stack, and make it the next to visit; a level in which
    nothing else is within reach is dropped.

    Returns three flags, 1 or 0: whether the child is a node to visit, whether it is a leaf to visit, and whether the
    stack is now empty.
    """
    top = rays.integers[TOP + ray]  # the number of a level: each ray has DEEPEST of them, from `ray * DEEPEST` on
    pending, depths = rays.integers[PENDING + top], load_half(rays.numbers, STACK + top * LEVEL)
    depths = where(mask_of(pending), depths, inf)
    within = bits(depths <= rays.numbers[LIMIT + ray])
    child = first(depths == least_lane(depths))  # any one where nothing is within reach: no flag says to visit it
    reference = int(rays.numbers[STACK + top * LEVEL + WIDE + child])
    # A leaf of a mesh lies among the nodes, at its negated reference; in place of others the root is fetched.
    prefetch_node(rays.nodes, rays.root + max(reference, -reference * rays.is_mesh), rays.is_mesh)
    rays.integers[PENDING + top] = pending ^ 1 << child
    rays.integers[NEXT + ray] = reference
    top = top - int(within & (within - 1) == 0)
    rays.integers[TOP + ray] = top
    return int((within != 0) & (reference >= 0)), int((within != 0) & (reference < 0)), int(top < ray * DEEPEST)


def mask_of(pending: int) -> Any:
    """Return the mask of the children with a bit in `pending`."""
    return pending >> np.arange(WIDE) & 1 != 0


def least_lane(x: Any) -> float:
    """Return the least of the lanes, none of which is NaN."""
    return float(x.min())
