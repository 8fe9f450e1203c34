"""Closest-hit and shadow queries for rays of any origins, by BVH traversal: `minirt.kernel.trace` for such rays.

Most packets of reflected rays and of shadow rays stay together: the rays of such a packet, one in each lane, traverse
the tree as one, and meet one shape at a time. Where only a few of them hit a box, each of these goes on by itself.
Marbles take 0.56 of the time that they take when all rays go by themselves.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

from minirt.kernel.bvh_meshes import visit_mesh, visit_meshes
from minirt.kernel.bvh_nodes import (
    DIRECTION,
    GROUPS,
    HIT,
    NODE,
    ORIGIN,
    PACKET,
    PACKET_LEVEL,
    REFERENCES,
    WIDTH,
    LeafGroup,
    Tree,
    leaf_number,
    least_lane,
    packet_memory,
    rays_in_box,
    reference_of,
    search_limit,
    store_rays,
    tag,
    vec_at,
)
from minirt.kernel.bvh_single_rays import traverse
from minirt.kernel.scene_arrays import Group, has_rows, intersect, occludes, read, read_block, read_one, read_row
from minirt.kernel.trace import DISTANCE, EXTENT, OWNER, ClosestHit, closer_hit, for_each_kind, triangle_extent
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
    outlined,
    save,
    save_vec,
    splat,
    where,
)

FEW = 6  # rays of a packet that go on one by one
FEW_IN_SMALL = 2  # likewise in a small tree, which has one node
APART = 1.0  # square of the difference of directions from which on all rays of a packet go one by one


def walk(
    visit: Callable[..., None], step: Callable[..., None], touch: Callable[..., None], tree: Tree, memory: Any
) -> None:
    """Intersect a packet with the shapes that its rays may hit, the nearest leaves first.

    `step(shape, index, extent, rays, memory)` may lessen the distances in `HIT`; where they are -infinity rays hit
    nothing. `visit` does the same for single rays, and `touch` for one of them and a triangle of a mesh.

    All rays traverse the tree together. Where few of them hit a box, each of these goes on by itself, see `traverse`;
    so does each ray of a packet whose directions differ much, unless the tree is small.
    """
    for_each_kind(visit_unbounded, tree.groups, 0, (step, tree, memory))
    active = load(memory, HIT) > -inf
    if not any(active):
        return
    is_small = tree.nodes.shape[0] <= NODE
    few = FEW_IN_SMALL if is_small else FEW
    apart = load_vec(memory, DIRECTION) - vec_at(memory, DIRECTION, first(active))
    rays = bits(active)
    if are_few(rays, few) or (not is_small and any(active & (dot(apart, apart) > APART))):
        traverse(visit, tree, memory, rays, 0.0)
        return
    at = PACKET
    push_children(tree.nodes, 0, memory, at)
    while at >= PACKET:
        tags = load(memory, at)
        nearest = least_lane(tags)
        if not nearest < search_limit(greatest(load(memory, HIT))):
            at -= PACKET_LEVEL
            continue
        child = first(tags == nearest)
        memory[at + child] = inf
        rays, reference = int(memory[at + WIDTH + child]), reference_of(nearest)
        if are_few(rays, few):
            traverse(visit, tree, memory, rays, nearest)
        elif reference >= 0:
            at += PACKET_LEVEL
            push_children(tree.nodes, reference, memory, at)
        else:
            for_each_kind(visit_leaf, tree.groups, leaf_number(reference), (step, touch, memory))


def are_few(rays: int, few: int) -> bool:
    """Whether there are no more than so few rays, one bit for each."""
    for _ in range(few):
        rays = rays & (rays - 1)
    return rays == 0


def push_children(nodes: Any, node: int, memory: Any, at: int) -> None:
    """Write a level of the packet's stack: the children of a node whose boxes any of its rays hits."""
    limit = search_limit(load(memory, HIT))
    save(splat(inf, limit), memory, at)
    for child in range(WIDTH):
        if nodes[node + child] == inf:
            break
        hit, near = rays_in_box(nodes, node + child, memory, limit)
        if any(hit):
            memory[at + child] = least_lane(where(hit, near, inf))
            memory[at + WIDTH + child] = bits(hit)
    near = load(memory, at)
    save(where(near < inf, tag(near, load(nodes, node + REFERENCES)), inf), memory, at)


def visit_unbounded(group: LeafGroup, state: int, arguments: tuple[Callable[..., None], Tree, Any]) -> int:
    """Intersect a packet with the unbounded shapes of one kind; the state is not changed."""
    if group.unbounded is not None:
        step, tree, memory = arguments
        for i in range(group.unbounded.shape[0]):
            index = group.unbounded[i]
            shape, rays = read(group.rows, tree.slots[index, 1]), load(memory, HIT) > -inf
            step(shape, index, tree.extents[index], rays, memory)
    return state


def visit_leaf(group: LeafGroup, leaf: int, arguments: tuple[Callable[..., None], Callable[..., None], Any]) -> int:
    """Intersect a packet with the shapes of a leaf, if they are of this kind; the state is not changed."""
    step, touch, memory = arguments
    if has_rows(group.blocks) and leaf % GROUPS == group.number:
        block = leaf // GROUPS
        for i in range(WIDTH):
            at = block * REFERENCES + i
            if group.boxes[at] == inf:
                break
            rays, _ = rays_in_box(group.boxes, at, memory, search_limit(load(memory, HIT)))
            if any(rays):
                index, extent = group.labels[block, i, 0], group.labels[block, i, 1]
                if group.trees is None:
                    step(read_one(group.blocks, block, i), index, extent, rays, memory)
                else:
                    visit_mesh(group, group.blocks[block, i], rays, step, touch, memory)
    return leaf


@outlined
def closest_hit(tree: Tree, origin: Vec, direction: Vec, active: Mask) -> ClosestHit:
    """Find the closest hit of each ray, as `minirt.kernel.trace.closest_hit` does; rays may have any origins.

    Rays that are not `active` hit nothing.
    """
    memory = packet_memory()
    store_rays(memory, origin, direction)
    farthest = where(active, splat(inf, direction.x), -inf)
    save_vec(Vec(farthest, splat(-1.0, farthest), splat(0.0, farthest)), memory, HIT)
    walk(closest_in_block, closest_of_shape, closest_of_triangle, tree, memory)
    hit = load_vec(memory, HIT)
    return where(active, hit.x, inf), hit.y, hit.z, -1


def closest_of_shape(shape: Any, index: int, extent: float, rays: Mask, memory: Any) -> None:
    """Continue `closest_hit` of some rays of a packet by one shape, and store the result in `HIT`."""
    origin, direction, best = load_vec(memory, ORIGIN), load_vec(memory, DIRECTION), load_vec(memory, HIT)
    hit, t = intersect(shape, origin, direction)
    state = closer_hit(shape, index, extent, hit & rays, t, origin, direction, (best.x, best.y, best.z, -1))
    save_vec(Vec(state[DISTANCE], state[OWNER], state[EXTENT]), memory, HIT)


def closest_in_block(group: LeafGroup, block: int, tree: Tree, memory: Any, ray: int) -> None:
    """Continue `closest_hit` of one ray over the shapes of a block, and store the result in `HIT`."""
    if group.trees is not None:
        visit_meshes(closest_of_triangle, group, block, memory, ray)
        return
    origin, direction = vec_at(memory, ORIGIN, ray), vec_at(memory, DIRECTION, ray)
    hit, t = intersect(read_block(group.blocks, block), origin, direction)
    candidates = bits(hit & (t <= search_limit(memory[HIT + ray])))
    if candidates != 0:
        best, owner, extent = memory[HIT + ray], memory[HIT + WIDTH + ray], memory[HIT + 2 * WIDTH + ray]
        while candidates != 0:
            i = lowest(candidates)
            candidates = candidates & (candidates - 1)
            shape = read_one(group.blocks, block, i)  # cached already, unlike the shape's row in `rows`
            label, state = group.labels[block, i], (best, owner, extent, -1)
            best, owner, extent, _ = closer_hit(shape, label[0], label[1], True, lane(t, i), origin, direction, state)
        memory[HIT + ray], memory[HIT + WIDTH + ray], memory[HIT + 2 * WIDTH + ray] = best, owner, extent


def closest_of_triangle(group: Group, row: int, index: int, memory: Any, ray: int) -> None:
    """Continue `closest_hit` of one ray by a triangle of a mesh, and store the result in `HIT`."""
    origin, direction = vec_at(memory, ORIGIN, ray), vec_at(memory, DIRECTION, ray)
    triangle = read_row(group, row)
    hit, t = intersect(triangle, origin, direction)
    if hit:
        state = memory[HIT + ray], memory[HIT + WIDTH + ray], memory[HIT + 2 * WIDTH + ray], -1
        best, owner, extent, _ = closer_hit(
            triangle, index, triangle_extent(triangle), True, t, origin, direction, state
        )
        memory[HIT + ray], memory[HIT + WIDTH + ray], memory[HIT + 2 * WIDTH + ray] = best, owner, extent


@outlined
def unoccluded(tree: Tree, origin: Vec, direction: Vec, distance: Number, active: Mask) -> Mask:
    """Trace shadow rays: the `active` rays that hit nothing nearer than `distance`."""
    memory = packet_memory()
    store_rays(memory, origin, direction)
    save(where(active, distance, -inf), memory, HIT)
    walk(occlude_by_block, occlude_by_shape, occlude_by_triangle, tree, memory)
    return load(memory, HIT) > -inf


def occlude_by_shape(shape: Any, index: int, extent: float, rays: Mask, memory: Any) -> None:
    """Set the distances in `HIT` of those of some shadow rays to -infinity that a shape occludes."""
    distance = load(memory, HIT)
    occluded = occludes(shape, load_vec(memory, ORIGIN), load_vec(memory, DIRECTION), distance)
    save(where(rays & occluded, -inf, distance), memory, HIT)


def occlude_by_block(group: LeafGroup, block: int, tree: Tree, memory: Any, ray: int) -> None:
    """Set the distance in `HIT` of a shadow ray to -infinity, which ends it, if a shape of a block occludes it."""
    if group.trees is not None:
        visit_meshes(occlude_by_triangle, group, block, memory, ray)
        return
    origin, direction, distance = vec_at(memory, ORIGIN, ray), vec_at(memory, DIRECTION, ray), memory[HIT + ray]
    occluded = any(occludes(read_block(group.blocks, block), origin, direction, distance))
    memory[HIT + ray] = where(occluded, -inf, distance)


def occlude_by_triangle(group: Group, row: int, index: int, memory: Any, ray: int) -> None:
    """Set the distance in `HIT` of a shadow ray to -infinity, which ends it, if a triangle of a mesh occludes it."""
    origin, direction, distance = vec_at(memory, ORIGIN, ray), vec_at(memory, DIRECTION, ray), memory[HIT + ray]
    occluded = occludes(read_row(group, row), origin, direction, distance)
    memory[HIT + ray] = where(occluded, -inf, distance)
