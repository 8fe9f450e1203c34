"""Closest-hit and shadow queries for incoherent rays, by BVH traversal; the counterpart of `minirt.kernel.trace`.

All rays of a packet advance together, one step of each in turn. A step waits for memory and for pipelines, and a
mispredicted branch costs all work that the processor began behind it. Steps of different rays do not wait for each
other. So the rays of a packet are interleaved, and a step has no branch: in its place is a mask with one bit for each
ray, and the nearest child is found among all lanes at once, not by sorting.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

from minirt.kernel.bvh_nodes import (
    DIRECTION,
    GROUPS,
    HIT,
    INVERSE,
    NEXT,
    ORIGIN,
    REFERENCES,
    STACK,
    STACK_LEVEL,
    TOP,
    WIDTH,
    Group,
    Tree,
    intersect_boxes,
    leaf_number,
    least_lane,
    near_planes,
    packet_memory,
    put_integer,
    reference_of,
    search_limit,
    store_rays,
    tag,
    vec_at,
)
from minirt.kernel.pixels import fetch_add
from minirt.kernel.scene_arrays import has_rows, intersect, kind_of, occludes, read, surface
from minirt.kernel.trace import Hit, closer_hit, for_each_kind, of_shape
from minirt.lanes import (
    Mask,
    Number,
    Vec,
    any,
    bits,
    lane,
    load,
    load_vec,
    lowest,
    max_norm,
    save,
    save_vec,
    splat,
    unit,
    where,
)

CHUNK = 16 * WIDTH  # rays that a thread claims at a time


def traverse(visit: Callable[..., None], tree: Tree, memory: Any, rays: int) -> None:
    """Call `visit(group, block, tree, memory, ray)` for the leaves that each of the `rays` hits, the nearest first.

    `rays` has one bit for each ray. Leaves beyond the distance in the first row of `HIT`, which `visit` may lessen, are
    skipped.
    """
    remaining = rays
    while remaining != 0:
        ray = lowest(remaining)
        remaining = remaining & (remaining - 1)
        memory[NEXT + ray] = 0.0  # the root
        put_integer(memory, TOP + ray, STACK - STACK_LEVEL + ray * WIDTH)
    at_node, unfinished = rays, 0
    while True:
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
            node, leaf, last = advance(memory, ray)
            at_node = at_node | node << ray
            at_leaf = at_leaf | leaf << ray
            unfinished = unfinished ^ last << ray
        for_each_kind(visit_leaves_of_kind, tree.groups, at_leaf, (visit, tree, memory))


def descend(nodes: Any, memory: Any, ray: int) -> int:
    """Push the children of the next node whose boxes a ray hits onto its stack; returns 1 if there are any, else 0."""
    node = reference_of(memory[NEXT + ray])
    planes = near_planes(vec_at(memory, INVERSE, ray))
    hit, near = intersect_boxes(nodes, node, memory, ray, planes, search_limit(memory[HIT + ray]))
    top = reference_of(memory[TOP + ray]) + STACK_LEVEL
    save(where(hit, tag(near, load(nodes, node + REFERENCES)), inf), memory, top)
    pushed = int(any(hit))
    put_integer(memory, TOP + ray, top - STACK_LEVEL * (1 - pushed))
    return pushed


def advance(memory: Any, ray: int) -> tuple[int, int, int]:
    """Pop the nearest child from the top row of a ray's stack, and make it the next to visit.

    Returns three flags, 1 or 0: whether the child is a node to visit, whether it is a leaf to visit, and whether the
    stack is now empty.
    """
    limit = search_limit(memory[HIT + ray])
    top = reference_of(memory[TOP + ray])
    tags = load(memory, top)
    nearest = least_lane(tags)
    others = where(tags == nearest, inf, tags)
    save(others, memory, top)
    top = top - STACK_LEVEL * (1 - int(any(others < limit)))
    put_integer(memory, TOP + ray, top)
    memory[NEXT + ray] = nearest
    in_reach = nearest < limit
    is_node = reference_of(nearest) >= 0
    return int(in_reach & is_node), int(in_reach & (not is_node)), int(top < STACK)


def visit_leaves_of_kind(group: Group, rays: int, arguments: tuple[Callable[..., None], Tree, Any]) -> int:
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


def closest_hit(tree: Tree, origin: Vec, direction: Vec, active: Mask) -> Hit:
    """Find the closest hit of each ray, as `minirt.kernel.trace.closest_hit` does; rays may have any origins.

    Rays that are not `active` hit unbounded shapes only.
    """
    memory = packet_memory()
    store_rays(memory, origin, direction)
    no_hit = splat(inf, direction.x), splat(-1.0, direction.x), splat(0.0, direction.x)
    best, owner, extent = for_each_kind(closest_unbounded, tree.groups, no_hit, (tree, origin, direction))
    save_vec(Vec(best, owner, extent), memory, HIT)
    traverse(closest_in_block, tree, memory, bits(active))
    hit = load_vec(memory, HIT)
    return hit.x, hit.y, hit.z


def closest_unbounded(group: Group, state: Hit, arguments: tuple[Tree, Vec, Vec]) -> Hit:
    """Continue `closest_hit` over the unbounded shapes of one kind."""
    if group.unbounded is None:
        return state
    tree, origin, direction = arguments
    for i in range(group.unbounded.shape[0]):
        index = group.unbounded[i]
        shape = read(group.rows, tree.slots[index, 1])
        hit, t = intersect(shape, origin, direction)
        state = closer_hit(shape, index, tree.extents[index], hit, t, origin, direction, state)
    return state


def closest_in_block(group: Group, block: int, tree: Tree, memory: Any, ray: int) -> None:
    """Continue `closest_hit` of one ray over the shapes of a block, and store the result in `HIT`."""
    origin, direction = vec_at(memory, ORIGIN, ray), vec_at(memory, DIRECTION, ray)
    hit, t = intersect(read_block(group.blocks, block), origin, direction)
    candidates = bits(hit & (t <= search_limit(memory[HIT + ray])))
    if candidates != 0:
        best = vec_at(memory, HIT, ray)
        state = best.x, best.y, best.z
        while candidates != 0:
            i = lowest(candidates)
            candidates = candidates & (candidates - 1)
            shape = read_one(group.blocks, block, i)  # cached already, unlike the shape's row in `rows`
            index, extent = group.labels[block, i, 0], group.labels[block, i, 1]
            state = closer_hit(shape, index, extent, True, lane(t, i), origin, direction, state)
        memory[HIT + ray], memory[HIT + WIDTH + ray], memory[HIT + 2 * WIDTH + ray] = state


def unoccluded(tree: Tree, origin: Vec, direction: Vec, distance: Number, active: Mask) -> Mask:
    """Trace shadow rays: the `active` rays that hit nothing nearer than `distance`."""
    memory = packet_memory()
    store_rays(memory, origin, direction)
    visible = for_each_kind(unoccluded_by_unbounded, tree.groups, active, (tree, origin, direction, distance))
    save(where(visible, distance, -inf), memory, HIT)
    traverse(occlude_by_block, tree, memory, bits(visible))
    return load(memory, HIT) > -inf


def unoccluded_by_unbounded(group: Group, visible: Mask, arguments: tuple[Tree, Vec, Vec, Number]) -> Mask:
    """Remove the shadow rays that an unbounded shape of one kind occludes from `visible`."""
    if group.unbounded is None:
        return visible
    tree, origin, direction, distance = arguments
    for i in range(group.unbounded.shape[0]):
        hit, t = occludes(read(group.rows, tree.slots[group.unbounded[i], 1]), origin, direction)
        visible = visible & ~(hit & (t < distance))
    return visible


def occlude_by_block(group: Group, block: int, tree: Tree, memory: Any, ray: int) -> None:
    """Set the distance in `HIT` of a shadow ray to -infinity, which ends it, if a shape of a block occludes it."""
    hit, t = occludes(read_block(group.blocks, block), vec_at(memory, ORIGIN, ray), vec_at(memory, DIRECTION, ray))
    memory[HIT + ray] = where(any(hit & (t < memory[HIT + ray])), -inf, memory[HIT + ray])


def read_block(blocks: Any, i: int) -> Any:
    """Return all shapes of a block as one packed shape, with one shape in each SIMD lane."""
    parts = (Vec(*part) if part.ndim == 2 else part for part in blocks[i])
    return kind_of(blocks.dtype.names).packed(*parts)


def read_one(blocks: Any, block: int, i: int) -> Any:
    """Return the packed shape in lane i of a block."""
    parts = (Vec(*part[:, i]) if part.ndim == 2 else part[i] for part in blocks[block])
    return kind_of(blocks.dtype.names).packed(*parts)


def trace_rays(
    next_ray: Any, tree: Tree, origins: Any, directions: Any, distances: Any, owners: Any, points: Any, normals: Any
) -> None:
    """Find the closest hits of n rays, claiming chunks of rays from the counter `next_ray` until none is left.

    Any number of threads may do so at the same time. Reads `origins` and `directions`, (n, 3), which may have any
    length. Writes `points` and `normals`, (n, 3), `distances` and `owners`, (n,), except for rays without a hit.
    """
    count = origins.shape[0]
    memory = packet_memory()
    while True:
        start = fetch_add(next_ray, CHUNK)
        if start >= count:
            return
        for first in range(start, min(start + CHUNK, count), WIDTH):
            for ray in range(WIDTH):
                memory[HIT + ray] = first + ray
                for axis in range(3):
                    memory[ORIGIN + axis * WIDTH + ray] = origins[min(first + ray, count - 1), axis]
                    memory[DIRECTION + axis * WIDTH + ray] = directions[min(first + ray, count - 1), axis]
            origin, direction = load_vec(memory, ORIGIN), unit(rescale(load_vec(memory, DIRECTION)))
            t, owner, _ = closest_hit(tree, origin, direction, load(memory, HIT) < count)
            save_vec(origin + t * direction, memory, ORIGIN)
            save_vec(Vec(t, owner, t), memory, HIT)
            for ray in range(min(WIDTH, count - first)):
                index = int(memory[HIT + WIDTH + ray])
                if index >= 0:
                    point = vec_at(memory, ORIGIN, ray)
                    on, normal = of_shape(surface, tree.groups, tree.slots[index], (point,), (point, point))
                    distances[first + ray], owners[first + ray] = memory[HIT + ray], index
                    store_vec(points, first + ray, on)
                    store_vec(normals, first + ray, normal)


def store_vec(vectors: Any, i: int, v: Vec) -> None:
    """Store a vector in row i of an array (n, 3)."""
    vectors[i, 0], vectors[i, 1], vectors[i, 2] = v.x, v.y, v.z


def rescale(v: Vec) -> Vec:
    """Scale a vector so that its largest coordinate is 1: its length then neither overflows nor underflows."""
    size = max_norm(v)
    return Vec(v.x / size, v.y / size, v.z / size)
