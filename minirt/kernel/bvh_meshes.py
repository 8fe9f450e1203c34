"""Rays of any origins at meshes, each of which is one shape in the tree of a scene and has a tree of its own."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from minirt.kernel.beam_traversal import fold_over_mesh
from minirt.kernel.bvh_nodes import DIRECTION, FACTOR, HIT, ORIGIN, vec_at
from minirt.kernel.bvh_rays import Rays, boxes_on_ray, search_limit, set_limit
from minirt.kernel.mesh_rays import triangles_along
from minirt.kernel.scene_arrays import read_row
from minirt.kernel.trace import triangle_extent
from minirt.lanes import Mask, Number, any, bits, first, load, load_vec, lowest, max_norm, splat

COHERENT = 0.25  # difference of directions up to which the rays of a packet enter a mesh together
BESIDE = 2.0**-6  # difference of their origins, of half of the size of the mesh, likewise


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


def visit_meshes(touch: Callable[..., None], group: Any, block: int, rays: Rays, ray: int) -> None:
    """Intersect one ray with the meshes of a block whose boxes it hits."""
    hit, _ = boxes_on_ray(rays, group.first_leaf + block, ray)
    remaining = bits(hit)
    while remaining != 0:
        triangles_along(touch, group, group.blocks[block, lowest(remaining)], rays.memory, 1 << ray)
        remaining = remaining & (remaining - 1)
    set_limit(rays, ray)
