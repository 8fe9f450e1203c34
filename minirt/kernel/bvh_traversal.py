"""Closest-hit and shadow queries for rays of any origins, by BVH traversal; the counterpart of `minirt.kernel.trace`.

Most packets of reflected rays and of shadow rays stay together: the rays of such a packet, one in each lane, traverse
the tree as one, and meet one shape at a time. Where only a few of them hit a box, each of these goes on by itself, and
meets all children of a node, or all shapes of a leaf, at a time. Marbles take 0.56 of the time that they take when all
rays go by themselves.

Single rays advance together, one step of each in turn. A step waits for memory and for pipelines, and a mispredicted
branch costs all work that the processor began behind it. Steps of different rays do not wait for each other. So the
rays are interleaved, and a step has no branch: in its place is a mask with one bit for each ray, and the nearest child
is found among all lanes at once, not by sorting.
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
    PACKET,
    PACKET_LEVEL,
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
    rays_in_box,
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
    dot,
    first,
    greatest,
    lane,
    load,
    load_vec,
    lowest,
    max_norm,
    outlined,
    save,
    save_vec,
    splat,
    unit,
    where,
)

CHUNK = 16 * WIDTH  # rays that a thread claims at a time
FEW = 6  # rays of a packet that go on one by one
APART = 1.0  # square of the difference of directions from which on all rays of a packet go one by one


def walk(visit: Callable[..., None], step: Callable[..., None], tree: Tree, memory: Any) -> None:
    """Intersect a packet with the shapes that its rays may hit, the nearest leaves first.

    `step(shape, index, extent, rays, memory)` may lessen the distances in `HIT`; where they are -infinity rays hit
    nothing. `visit` does the same for single rays.

    All rays traverse the tree together. Where few of them hit a box, each of them goes on by itself, see `traverse`; so
    does each ray of a packet whose directions differ much, or that enters boxes by different planes.
    """
    for_each_kind(visit_unbounded, tree.groups, 0, (step, tree, memory))
    active, inverse = load(memory, HIT) > -inf, load_vec(memory, INVERSE)
    if not any(active):
        return
    apart = load_vec(memory, DIRECTION) - vec_at(memory, DIRECTION, first(active))
    differ = differ_in_sign(inverse.x, active) or differ_in_sign(inverse.y, active) or differ_in_sign(inverse.z, active)
    differ = differ or any(active & (dot(apart, apart) > APART))
    planes = near_planes(vec_at(memory, INVERSE, first(active)))
    at = PACKET
    save(splat(inf, inverse.x), memory, at)
    memory[at], memory[at + WIDTH] = 0.0, bits(active)  # the root
    while at >= PACKET:
        tags = load(memory, at)
        nearest = least_lane(tags)
        if not nearest < search_limit(greatest(load(memory, HIT))):
            at -= PACKET_LEVEL
            continue
        child = first(tags == nearest)
        memory[at + child] = inf
        rays, reference = int(memory[at + WIDTH + child]), reference_of(nearest)
        if differ or are_few(rays):
            traverse(visit, tree, memory, rays, nearest)
        elif reference >= 0:
            at += PACKET_LEVEL
            push_children(tree.nodes, reference, memory, planes, at)
        else:
            for_each_kind(visit_leaf, tree.groups, leaf_number(reference), (step, memory, planes))


def differ_in_sign(x: Number, rays: Mask) -> bool:
    """Whether a number is positive for some rays and negative for others."""
    return any(rays & (x > 0.0)) and any(rays & (x < 0.0))


def are_few(rays: int) -> bool:
    """Whether there are so few rays, one bit for each, that each of them goes on by itself."""
    for _ in range(FEW):
        rays = rays & (rays - 1)
    return rays == 0


def push_children(nodes: Any, node: int, memory: Any, planes: tuple[int, int, int], at: int) -> None:
    """Write a level of the packet's stack: the children of a node whose boxes any of its rays hits."""
    limit = search_limit(load(memory, HIT))
    save(splat(inf, limit), memory, at)
    for child in range(WIDTH):
        if nodes[node + child] == inf:
            break
        hit, near = rays_in_box(nodes, node + child, memory, planes, limit)
        if any(hit):
            memory[at + child] = least_lane(where(hit, near, inf))
            memory[at + WIDTH + child] = bits(hit)
    near = load(memory, at)
    save(where(near < inf, tag(near, load(nodes, node + REFERENCES)), inf), memory, at)


def visit_unbounded(group: Group, state: int, arguments: tuple[Callable[..., None], Tree, Any]) -> int:
    """Intersect a packet with the unbounded shapes of one kind; the state is not changed."""
    if group.unbounded is not None:
        step, tree, memory = arguments
        for i in range(group.unbounded.shape[0]):
            index = group.unbounded[i]
            shape, rays = read(group.rows, tree.slots[index, 1]), load(memory, HIT) > -inf
            step(shape, index, tree.extents[index], rays, memory)
    return state


def visit_leaf(group: Group, leaf: int, arguments: tuple[Callable[..., None], Any, tuple[int, int, int]]) -> int:
    """Intersect a packet with the shapes of a leaf, if they are of this kind; the state is not changed."""
    step, memory, planes = arguments
    if has_rows(group.blocks) and leaf % GROUPS == group.number:
        block = leaf // GROUPS
        for i in range(WIDTH):
            at = block * REFERENCES + i
            if group.boxes[at] == inf:
                break
            rays, _ = rays_in_box(group.boxes, at, memory, planes, search_limit(load(memory, HIT)))
            if any(rays):
                index, extent = group.labels[block, i, 0], group.labels[block, i, 1]
                step(read_one(group.blocks, block, i), index, extent, rays, memory)
    return leaf


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
            node, leaf, last = advance(memory, ray)
            at_node = at_node | node << ray
            at_leaf = at_leaf | leaf << ray
            unfinished = unfinished ^ last << ray


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


@outlined
def closest_hit(tree: Tree, origin: Vec, direction: Vec, active: Mask) -> Hit:
    """Find the closest hit of each ray, as `minirt.kernel.trace.closest_hit` does; rays may have any origins.

    Rays that are not `active` hit nothing.
    """
    memory = packet_memory()
    store_rays(memory, origin, direction)
    farthest = where(active, splat(inf, direction.x), -inf)
    save_vec(Vec(farthest, splat(-1.0, farthest), splat(0.0, farthest)), memory, HIT)
    walk(closest_in_block, closest_of_shape, tree, memory)
    hit = load_vec(memory, HIT)
    return where(active, hit.x, inf), hit.y, hit.z


def closest_of_shape(shape: Any, index: int, extent: float, rays: Mask, memory: Any) -> None:
    """Continue `closest_hit` of some rays of a packet by one shape, and store the result in `HIT`."""
    origin, direction, best = load_vec(memory, ORIGIN), load_vec(memory, DIRECTION), load_vec(memory, HIT)
    hit, t = intersect(shape, origin, direction)
    state = closer_hit(shape, index, extent, hit & rays, t, origin, direction, (best.x, best.y, best.z))
    save_vec(Vec(state[0], state[1], state[2]), memory, HIT)


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


@outlined
def unoccluded(tree: Tree, origin: Vec, direction: Vec, distance: Number, active: Mask) -> Mask:
    """Trace shadow rays: the `active` rays that hit nothing nearer than `distance`."""
    memory = packet_memory()
    store_rays(memory, origin, direction)
    save(where(active, distance, -inf), memory, HIT)
    walk(occlude_by_block, occlude_by_shape, tree, memory)
    return load(memory, HIT) > -inf


def occlude_by_shape(shape: Any, index: int, extent: float, rays: Mask, memory: Any) -> None:
    """Set the distances in `HIT` of those of some shadow rays to -infinity that a shape occludes."""
    distance = load(memory, HIT)
    occluded = occludes(shape, load_vec(memory, ORIGIN), load_vec(memory, DIRECTION), distance)
    save(where(rays & occluded, -inf, distance), memory, HIT)


def occlude_by_block(group: Group, block: int, tree: Tree, memory: Any, ray: int) -> None:
    """Set the distance in `HIT` of a shadow ray to -infinity, which ends it, if a shape of a block occludes it."""
    origin, direction, distance = vec_at(memory, ORIGIN, ray), vec_at(memory, DIRECTION, ray), memory[HIT + ray]
    occluded = any(occludes(read_block(group.blocks, block), origin, direction, distance))
    memory[HIT + ray] = where(occluded, -inf, distance)


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
        for begin in range(start, min(start + CHUNK, count), WIDTH):
            for ray in range(WIDTH):
                memory[HIT + ray] = begin + ray
                for axis in range(3):
                    memory[ORIGIN + axis * WIDTH + ray] = origins[min(begin + ray, count - 1), axis]
                    memory[DIRECTION + axis * WIDTH + ray] = directions[min(begin + ray, count - 1), axis]
            origin, direction = load_vec(memory, ORIGIN), unit(rescale(load_vec(memory, DIRECTION)))
            t, owner, _ = closest_hit(tree, origin, direction, load(memory, HIT) < count)
            save_vec(origin + t * direction, memory, ORIGIN)
            save_vec(Vec(t, owner, t), memory, HIT)
            for ray in range(min(WIDTH, count - begin)):
                index = int(memory[HIT + WIDTH + ray])
                if index >= 0:
                    point = vec_at(memory, ORIGIN, ray)
                    on, normal = of_shape(surface, tree.groups, tree.slots[index], (point,), (point, point))
                    distances[begin + ray], owners[begin + ray] = memory[HIT + ray], index
                    store_vec(points, begin + ray, on)
                    store_vec(normals, begin + ray, normal)


def store_vec(vectors: Any, i: int, v: Vec) -> None:
    """Store a vector in row i of an array (n, 3)."""
    vectors[i, 0], vectors[i, 1], vectors[i, 2] = v.x, v.y, v.z


def rescale(v: Vec) -> Vec:
    """Scale a vector so that its largest coordinate is 1: its length then neither overflows nor underflows."""
    size = max_norm(v)
    return Vec(v.x / size, v.y / size, v.z / size)
