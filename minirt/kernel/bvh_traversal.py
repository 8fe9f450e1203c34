"""Closest-hit and shadow queries for rays of any origins, by BVH traversal: `minirt.kernel.trace` for such rays.

Most packets of reflected rays and of shadow rays stay together: the rays of such a packet, one in each lane, traverse
the tree as one, and meet one shape at a time. Where only a few of them hit a box, each of these goes on by itself.
Marbles take 0.56 of the time that they take when all rays go by themselves.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

from minirt.kernel.bvh_leaves import all_leaves, visit_leaf, visit_leaves, visit_meshes, visit_unbounded
from minirt.kernel.bvh_nodes import (
    DEEPEST,
    DIRECTION,
    HIT,
    NODE,
    ORIGIN,
    REFERENCES,
    WIDE,
    WIDTH,
    LeafGroup,
    Tree,
    packet_memory,
    vec_at,
)
from minirt.kernel.bvh_rays import (
    HITS,
    LEVEL,
    LIMIT,
    NEXT,
    PACKET,
    PENDING,
    STACK,
    TOP,
    RayPacket,
    ray_integers,
    ray_numbers,
    rays_in_box,
    search_limit,
    set_limit,
    store_rays,
)
from minirt.kernel.bvh_single_rays import advance, least_lane, traverse
from minirt.kernel.scene_arrays import Group, intersect, occludes, read_block, read_one, read_row
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
from minirt.lanes.memory import load_half

FEW = 6  # rays of a packet that go on one by one
FEW_IN_SMALL = 2  # likewise in a small tree, which has one node
SMALL = (1 + WIDE) * NODE  # numbers of a small tree, at most
APART = 1.0  # square of the difference of directions from which on all rays of a packet go one by one


def walk(
    visit: Callable[..., None], step: Callable[..., None], touch: Callable[..., None], tree: Tree, rays: RayPacket
) -> None:
    """Intersect a packet with the shapes that its rays may hit, the nearest leaves first.

    `step(shape, index, extent, hits, memory)` may lessen the distances in `HIT`; where they are -infinity rays hit
    nothing. `visit(group, block, rays, ray)` does the same for a single ray and a leaf, and
    `touch(group, row, index, memory, ray)` for a single ray and a triangle of a mesh.

    All rays traverse the tree together. Where few of them hit a box, each of these goes on by itself, see `traverse`;
    so does each ray of a packet whose directions differ much, unless the tree is small.
    """
    memory, numbers, integers = rays.memory, rays.numbers, rays.integers
    for_each_kind(visit_unbounded, tree.groups, 0, (step, tree, memory))
    active = load(memory, HIT) > -inf
    if not any(active):
        return
    store_rays(rays)
    is_small = tree.nodes.shape[0] <= SMALL
    few = FEW_IN_SMALL if is_small else FEW
    apart = load_vec(memory, DIRECTION) - vec_at(memory, DIRECTION, first(active))
    chosen = bits(active)
    if are_few(chosen, few) or (not is_small and any(active & (dot(apart, apart) > APART))):
        traverse(all_leaves, visit_leaves, (visit, tree), rays, chosen, 0)
        return
    integers[TOP + PACKET] = PACKET * DEEPEST - 1
    push_children(rays, 0)
    while integers[TOP + PACKET] >= PACKET * DEEPEST:
        numbers[LIMIT + PACKET] = greatest(load_half(numbers, LIMIT))
        top = integers[TOP + PACKET]
        pending = integers[PENDING + top]
        is_node, is_leaf, _ = advance(rays, PACKET)
        child, reference = lowest(int(pending ^ integers[PENDING + top])), integers[NEXT + PACKET]
        chosen = int(integers[HITS + (top - PACKET * DEEPEST) * WIDE + child])
        if is_node + is_leaf > 0:
            if are_few(chosen, few):
                traverse(all_leaves, visit_leaves, (visit, tree), rays, chosen, reference)
            elif is_node > 0:
                push_children(rays, reference)
            else:
                for_each_kind(visit_leaf, tree.groups, -reference, (step, touch, rays))


def are_few(rays: int, few: int) -> bool:
    """Whether there are no more than so few rays, one bit for each."""
    for _ in range(few):
        rays = rays & (rays - 1)
    return rays == 0


def push_children(rays: RayPacket, node: int) -> None:
    """Push the children of a node whose boxes any ray of a packet hits onto the packet's stack."""
    numbers, integers = rays.numbers, rays.integers
    top, pushed = integers[TOP + PACKET] + 1, 0
    for child in range(WIDE):
        if rays.nodes[node * NODE + child] == inf:
            break
        hit, near = rays_in_box(rays, node, child)
        if any(hit):
            numbers[STACK + top * LEVEL + child] = least_lane(where(hit, near, inf))
            integers[HITS + (top - PACKET * DEEPEST) * WIDE + child] = bits(hit)
            pushed = pushed | 1 << child
    save(load_half(rays.nodes, node * NODE + REFERENCES), numbers, STACK + top * LEVEL + WIDE)
    integers[PENDING + top], integers[TOP + PACKET] = pushed, top - int(pushed == 0)


@outlined
def closest_hit(tree: Tree, origin: Vec, direction: Vec, active: Mask) -> ClosestHit:
    """Find the closest hit of each ray, as `minirt.kernel.trace.closest_hit` does; rays may have any origins.

    Rays that are not `active` hit nothing.
    """
    memory, numbers, integers = packet_memory(), ray_numbers(), ray_integers()
    save_vec(origin, memory, ORIGIN)
    save_vec(direction, memory, DIRECTION)
    farthest = where(active, splat(inf, direction.x), -inf)
    save_vec(Vec(farthest, splat(-1.0, farthest), splat(0.0, farthest)), memory, HIT)
    rays = RayPacket(tree.nodes, 0, tree.place, memory, numbers, integers, 0)
    walk(closest_in_block, closest_of_shape, closest_of_triangle, tree, rays)
    hit = load_vec(memory, HIT)
    return where(active, hit.x, inf), hit.y, hit.z, -1


def closest_of_shape(shape: Any, index: int, extent: float, rays: Mask, memory: Any) -> None:
    """Continue `closest_hit` of some rays of a packet by one shape, and store the result in `HIT`."""
    origin, direction, best = load_vec(memory, ORIGIN), load_vec(memory, DIRECTION), load_vec(memory, HIT)
    hit, t = intersect(shape, origin, direction)
    state = closer_hit(shape, index, extent, hit & rays, t, origin, direction, (best.x, best.y, best.z, -1))
    save_vec(Vec(state[DISTANCE], state[OWNER], state[EXTENT]), memory, HIT)


def closest_in_block(group: LeafGroup, block: int, rays: RayPacket, ray: int) -> None:
    """Continue `closest_hit` of one ray over the shapes of a leaf, and store the result in `HIT`."""
    if group.trees is not None:
        visit_meshes(closest_of_triangle, group, block, rays, ray)
        return
    memory = rays.memory
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
        set_limit(rays, ray)


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
    memory, numbers, integers = packet_memory(), ray_numbers(), ray_integers()
    save_vec(origin, memory, ORIGIN)
    save_vec(direction, memory, DIRECTION)
    save(where(active, distance, -inf), memory, HIT)
    rays = RayPacket(tree.nodes, 0, tree.place, memory, numbers, integers, 0)
    walk(occlude_by_block, occlude_by_shape, occlude_by_triangle, tree, rays)
    return load(memory, HIT) > -inf


def occlude_by_shape(shape: Any, index: int, extent: float, rays: Mask, memory: Any) -> None:
    """Set the distances in `HIT` of those of some shadow rays to -infinity that a shape occludes."""
    distance = load(memory, HIT)
    occluded = occludes(shape, load_vec(memory, ORIGIN), load_vec(memory, DIRECTION), distance)
    save(where(rays & occluded, -inf, distance), memory, HIT)


def occlude_by_block(group: LeafGroup, block: int, rays: RayPacket, ray: int) -> None:
    """Set the distance in `HIT` of a shadow ray to -infinity, which ends it, if a shape of a leaf occludes it."""
    if group.trees is not None:
        visit_meshes(occlude_by_triangle, group, block, rays, ray)
        return
    memory = rays.memory
    origin, direction, distance = vec_at(memory, ORIGIN, ray), vec_at(memory, DIRECTION, ray), memory[HIT + ray]
    occluded = any(occludes(read_block(group.blocks, block), origin, direction, distance))
    memory[HIT + ray] = where(occluded, -inf, distance)
    rays.numbers[LIMIT + ray] = where(occluded, -inf, rays.numbers[LIMIT + ray])


def occlude_by_triangle(group: Group, row: int, index: int, memory: Any, ray: int) -> None:
    """Set the distance in `HIT` of a shadow ray to -infinity, which ends it, if a triangle of a mesh occludes it."""
    origin, direction, distance = vec_at(memory, ORIGIN, ray), vec_at(memory, DIRECTION, ray), memory[HIT + ray]
    occluded = occludes(read_row(group, row), origin, direction, distance)
    memory[HIT + ray] = where(occluded, -inf, distance)
