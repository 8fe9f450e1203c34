"""Closest-hit and shadow queries for incoherent rays, by BVH traversal; the counterpart of `minirt.kernel.trace`."""

from __future__ import annotations

from math import inf
from typing import Any

from minirt.kernel.atomic_counter import fetch_add
from minirt.kernel.bvh.nodes import (
    DIRECTION,
    HIT,
    ORIGIN,
    WIDTH,
    Group,
    Tree,
    bits,
    packet_memory,
    put,
    put_vec,
    search_limit,
    store_rays,
    vec_at,
)
from minirt.kernel.bvh.traversal import traverse
from minirt.kernel.rows import intersect, kind_of, occludes, read, surface
from minirt.kernel.scene_arrays import by_reference
from minirt.kernel.trace import closer_hit, for_each_kind
from minirt.lanes import Mask, Number, Vec, any, lane, load, lowest, max_norm, splat, unit, where

CHUNK = 16 * WIDTH  # rays that a thread claims at a time

Hit = tuple[Number, Number, Number]  # distance, index and extent of the shape that is hit


def closest_hit(tree: Tree, origin: Vec, direction: Vec, active: Mask) -> Hit:
    """Find the closest hit of each ray, as `minirt.kernel.trace.closest_hit` does; rays may have any origins.

    Rays that are not `active` hit unbounded shapes only.
    """
    memory = packet_memory()
    store_rays(memory, origin, direction)
    no_hit = splat(inf, direction.x), splat(-1.0, direction.x), splat(0.0, direction.x)
    best, owner, extent = for_each_kind(closest_unbounded, tree.groups, no_hit, (tree, origin, direction))
    put_vec(memory, HIT, Vec(best, owner, extent))
    traverse(closest_in_block, tree, memory, bits(active))
    return load(memory, HIT), load(memory, HIT + WIDTH), load(memory, HIT + 2 * WIDTH)


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
    put(memory, HIT, where(visible, distance, -inf))
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
    tree = by_reference(tree)
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
            origin, direction = vec_lanes_at(memory, ORIGIN), unit(rescale(vec_lanes_at(memory, DIRECTION)))
            t, owner, _ = closest_hit(tree, origin, direction, load(memory, HIT) < count)
            put_vec(memory, ORIGIN, origin + t * direction)
            put_vec(memory, HIT, Vec(t, owner, t))
            for ray in range(min(WIDTH, count - first)):
                index = int(memory[HIT + WIDTH + ray])
                if index >= 0:
                    point = vec_at(memory, ORIGIN, ray)
                    group, row = tree.slots[index, 0], tree.slots[index, 1]
                    on, normal = for_each_kind(surface_of_kind, tree.groups, (point, point), (group, row, point))
                    distances[first + ray], owners[first + ray] = memory[HIT + ray], index
                    store_vec(points, first + ray, on)
                    store_vec(normals, first + ray, normal)


def vec_lanes_at(memory: Any, at: int) -> Vec:
    """Load the vectors of all rays of a packet from its memory."""
    return Vec(load(memory, at), load(memory, at + WIDTH), load(memory, at + 2 * WIDTH))


def store_vec(vectors: Any, i: int, v: Vec) -> None:
    """Store a vector in row i of an array (n, 3)."""
    vectors[i, 0], vectors[i, 1], vectors[i, 2] = v.x, v.y, v.z


def rescale(v: Vec) -> Vec:
    """Scale a vector so that its largest coordinate is 1: its length then neither overflows nor underflows."""
    size = max_norm(v)
    return Vec(v.x / size, v.y / size, v.z / size)


def surface_of_kind(group: Group, state: tuple[Vec, Vec], arguments: tuple[int, int, Vec]) -> tuple[Vec, Vec]:
    """Compute point and normal of the shape in a row of group `number` if it is of this kind."""
    on, normal = state
    number, row, point = arguments
    if number == group.number:
        on, normal = surface(read(group.rows, row), point)
    return on, normal
