"""Traversal of the trees of meshes by single rays, several of which advance together, one step of each in turn.

What a ray visits next is prefetched, and while it is on its way the other rays are served. See
`minirt.kernel.bvh_single_rays`, which does the same in the tree of a scene.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

import numpy as np

from minirt.kernel.bvh_nodes import DIRECTION, ORIGIN, WIDTH, least_lane
from minirt.kernel.mesh_nodes import NODE, REFERENCES, WIDE, prefetch_node
from minirt.kernel.mesh_rays import (
    LIMIT,
    ROWS,
    boxes_on_ray,
    ray_numbers,
    set_limit,
    store_rays,
    triangles_on_ray,
)
from minirt.kernel.scene_arrays import LEVELS, Group, prefetch_triangle
from minirt.lanes import (
    any,
    bits,
    first,
    load_vec,
    lowest,
    save,
    where,
)
from minirt.lanes.memory import load_half

# Integers of a traversal: for each ray the node that it visits next, the top row of its stack, and which triangles of a
# leaf it may hit; and for each row the node whose children are there.
NEXT, TOP, CANDIDATES, PARENTS = 0, WIDTH, 2 * WIDTH, 3 * WIDTH
INTEGERS = PARENTS + WIDTH * LEVELS


def ray_integers() -> Any:
    """Allocate the integers of a traversal; compiled, they lie on the stack of the thread."""
    return np.zeros(INTEGERS, np.int64)


def triangles_along(visit: Callable[..., None], group: Group, row: int, memory: Any, rays: int) -> None:
    """Call `visit(group, row, index, memory, ray)` for the triangles of a mesh that rays may hit, the nearest nodes
    first, up to the distance in the first row of `HIT`, which `visit` may lessen.

    `row` is that of the first triangle of the mesh. The rays are those of the packet's memory with a bit in `rays`.
    """
    mesh = group.trees.numbers[row]
    place, start, nodes = group.trees.places[mesh], group.trees.starts[mesh], group.trees.nodes
    numbers, integers = ray_numbers(), ray_integers()
    store_rays(place, load_vec(memory, ORIGIN), load_vec(memory, DIRECTION), numbers)
    remaining = rays
    while remaining != 0:
        ray = lowest(remaining)
        remaining = remaining & (remaining - 1)
        set_limit(place, memory, numbers, ray)
        integers[NEXT + ray], integers[TOP + ray] = start[0], -1
    at_node, at_leaf, unfinished = rays, 0, 0
    while True:
        remaining, at_leaf = at_leaf, 0
        while remaining != 0:
            ray = lowest(remaining)
            remaining = remaining & (remaining - 1)
            at_leaf = at_leaf | find_candidates(group, row, numbers, integers, ray) << ray
        remaining = at_node
        while remaining != 0:
            ray = lowest(remaining)
            remaining = remaining & (remaining - 1)
            unfinished = unfinished | descend(nodes, numbers, integers, ray) << ray
        while at_leaf != 0:
            ray = lowest(at_leaf)
            at_leaf = at_leaf & (at_leaf - 1)
            visit_candidates(visit, group, row, memory, numbers, integers, ray)
        if unfinished == 0:
            return
        at_node, remaining = 0, unfinished
        while remaining != 0:
            ray = lowest(remaining)
            remaining = remaining & (remaining - 1)
            node, leaf, last = advance(nodes, start[0], numbers, integers, ray)
            at_node, at_leaf = at_node | node << ray, at_leaf | leaf << ray
            unfinished = unfinished ^ last << ray


def descend(nodes: Any, numbers: Any, integers: Any, ray: int) -> int:
    """Push the children of the next node whose boxes a ray hits onto its stack; returns 1 if the stack has any."""
    node, top = integers[NEXT + ray], integers[TOP + ray] + 1
    hit, near = boxes_on_ray(nodes, node * NODE, numbers, ray)
    save(where(hit, near, inf), numbers, ROWS + (ray * LEVELS + top) * WIDE)
    integers[PARENTS + ray * LEVELS + top] = node
    top = top - 1 + int(any(hit))
    integers[TOP + ray] = top
    return int(top >= 0)


def advance(nodes: Any, root: int, numbers: Any, integers: Any, ray: int) -> tuple[int, int, int]:
    """Pop the nearest child from the top row of a ray's stack, and make it the next to visit; a row in which nothing
    else is within reach is dropped.

    Returns three flags, 1 or 0: whether the child is a node to visit, whether it is a leaf to visit, and whether the
    stack is now empty.
    """
    top = integers[TOP + ray]
    at = ROWS + (ray * LEVELS + top) * WIDE
    depths = load_half(numbers, at)
    within = bits(depths <= numbers[LIMIT + ray])
    child = first(depths == least_lane(depths))
    numbers[at + child] = inf
    reference = int(nodes[integers[PARENTS + ray * LEVELS + top] * NODE + REFERENCES + child])
    node = root + abs(reference)
    prefetch_node(nodes, node)
    integers[NEXT + ray] = node
    top = top - int(within & (within - 1) == 0)
    integers[TOP + ray] = top
    return int((within != 0) & (reference >= 0)), int((within != 0) & (reference < 0)), int(top < 0)


def find_candidates(group: Group, row: int, numbers: Any, integers: Any, ray: int) -> int:
    """Find the triangles of the next leaf that a ray may hit, and prefetch the first; returns 1 if there are any."""
    nodes, triangles, node = group.trees.nodes, group.triangles, integers[NEXT + ray] * NODE
    candidates = bits(triangles_on_ray(nodes, node, numbers, ray))
    integers[CANDIDATES + ray] = candidates
    if candidates != 0:
        triangle = row + int(-1.0 - nodes[node + REFERENCES + lowest(candidates)])
        prefetch_triangle(triangles, triangle)
    return int(candidates != 0)


def visit_candidates(
    visit: Callable[..., None], group: Group, row: int, memory: Any, numbers: Any, integers: Any, ray: int
) -> None:
    """Visit the triangles that `find_candidates` found for a ray."""
    mesh, at = group.trees.numbers[row], integers[NEXT + ray] * NODE + REFERENCES
    candidates = int(integers[CANDIDATES + ray])
    while candidates != 0:
        triangle = int(-1.0 - group.trees.nodes[at + lowest(candidates)])
        candidates = candidates & (candidates - 1)
        visit(group, row + triangle, group.trees.starts[mesh, 1] + triangle, memory, ray)
    set_limit(group.trees.places[mesh], memory, numbers, ray)
