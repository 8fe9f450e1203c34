"""Leaves of the tree of a scene, blocks of shapes of one kind; its unbounded shapes; and meshes, each of which is one
shape there and has a tree of its own."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

from minirt.kernel.beam_traversal import fold_over_mesh
from minirt.kernel.bvh_nodes import DIRECTION, FACTOR, HIT, NODE, ORIGIN, WIDE, LeafGroup, Tree, vec_at
from minirt.kernel.bvh_rays import NEXT, RayPacket, boxes_on_ray, rays_in_box, search_limit, set_limit, set_limits
from minirt.kernel.mesh_rays import triangles_along
from minirt.kernel.scene_arrays import ROW, has_rows, read, read_one, read_row
from minirt.kernel.trace import for_each_kind, triangle_extent
from minirt.lanes import Mask, Number, any, bits, first, load, load_vec, lowest, max_norm, splat

COHERENT = 0.25  # difference of directions up to which the rays of a packet enter a mesh together
BESIDE = 2.0**-6  # difference of their origins, of half of the size of the mesh, likewise


def visit_unbounded(group: LeafGroup, state: int, arguments: tuple[Callable[..., None], Tree, Any]) -> int:
    """Intersect a packet with the unbounded shapes of one kind; the state is not changed."""
    if group.unbounded is not None:
        step, tree, memory = arguments
        for i in range(group.unbounded.shape[0]):
            index = group.unbounded[i]
            row = tree.slots[index, ROW]
            shape, active = read(group.rows, row), load(memory, HIT) > -inf
            step(shape, index, tree.extents[index], active, memory)
    return state


def visit_leaf(
    group: LeafGroup, leaf: int, arguments: tuple[Callable[..., None], Callable[..., None], RayPacket]
) -> int:
    """Intersect a packet with the shapes of a leaf, if they are of this kind; the state is not changed."""
    step, touch, rays = arguments
    if has_rows(group.blocks) and 0 <= leaf - group.first_leaf < group.blocks.shape[0]:
        block = leaf - group.first_leaf
        for i in range(WIDE):
            if rays.nodes[leaf * NODE + i] == inf:
                break
            hit, _ = rays_in_box(rays, leaf, i)
            if any(hit):
                index, extent = group.labels[block, i, 0], group.labels[block, i, 1]
                if group.trees is None:
                    step(read_one(group.blocks, block, i), index, extent, hit, rays.memory)
                else:
                    visit_mesh(group, group.blocks[block, i], hit, step, touch, rays.memory)
                set_limits(rays)
    return leaf


def all_leaves(rays: RayPacket, at_leaf: int, data: tuple[Callable[..., None], Tree]) -> int:
    """Visit all leaves that single rays are at: nothing is to be prepared."""
    return at_leaf


def visit_leaves(rays: RayPacket, at_leaf: int, data: tuple[Callable[..., None], Tree]) -> None:
    """Visit the leaves that single rays are at, one bit for each in `at_leaf`."""
    visit, tree = data
    for_each_kind(visit_leaves_of_kind, tree.groups, at_leaf, (visit, rays))


def visit_leaves_of_kind(group: LeafGroup, at_leaf: int, arguments: tuple[Callable[..., None], RayPacket]) -> int:
    """Visit those leaves whose shapes are of one kind; the state, `at_leaf`, is not changed."""
    visit, rays = arguments
    remaining = at_leaf if has_rows(group.blocks) else 0
    while remaining != 0:
        ray = lowest(remaining)
        remaining = remaining & (remaining - 1)
        block = -rays.integers[NEXT + ray] - group.first_leaf
        if 0 <= block < group.blocks.shape[0]:
            visit(group, block, rays, ray)
    return at_leaf


def visit_mesh(
    group: Any, row: int, rays: Mask, step: Callable[..., None], touch: Callable[..., None], memory: Any
) -> None:
    """Intersect some rays of a packet with a mesh, whose first triangle is in a row: by a beam if they are close
    together, each by itself if not."""
    origin, direction = load_vec(memory, ORIGIN), load_vec(memory, DIRECTION)
    ray = first(rays)
    aside = max_norm(direction - vec_at(memory, DIRECTION, ray))
    away = max_norm(origin - vec_at(memory, ORIGIN, ray)) * group.trees.places[group.trees.numbers[row], FACTOR]
    if any(rays & ((aside > COHERENT) | (away > BESIDE))):
        triangles_along(touch, group, row, memory, bits(rays))
    else:
        packet = origin, direction, splat(-1.0, direction.x)  # rays that start on no triangle
        fold_over_mesh(step_of_triangle, reach_of_packet, group, row, packet, rays, 0, (step, memory))


def step_of_triangle(
    group: Any, row: int, index: int, rays: Mask, state: int, data: tuple[Callable[..., None], Any]
) -> int:
    """Intersect some rays of a packet with a triangle of a mesh; the state is not changed."""
    step, memory = data
    triangle = read_row(group, row)
    step(triangle, index, triangle_extent(triangle), rays, memory)
    return state


def reach_of_packet(state: int, data: tuple[Callable[..., None], Any]) -> Number:
    """Return how far to follow the rays of a packet."""
    return search_limit(load(data[1], HIT))


def visit_meshes(touch: Callable[..., None], group: Any, block: int, rays: RayPacket, ray: int) -> None:
    """Intersect one ray with the meshes of a block whose boxes it hits."""
    hit, _ = boxes_on_ray(rays, group.first_leaf + block, ray)
    remaining = bits(hit)
    while remaining != 0:
        triangles_along(touch, group, group.blocks[block, lowest(remaining)], rays.memory, 1 << ray)
        remaining = remaining & (remaining - 1)
    set_limit(rays, ray)
