"""Closest hits of any number of rays from arrays, for `minirt.trace`."""

from __future__ import annotations

from math import nan
from typing import Any

from minirt.kernel.bvh_nodes import DIRECTION, HIT, ORIGIN, WIDTH, Tree, packet_memory, vec_at
from minirt.kernel.bvh_traversal import closest_hit
from minirt.kernel.pixels import fetch_add
from minirt.kernel.scene_arrays import store_vec, surface
from minirt.kernel.trace import of_shape
from minirt.lanes import Vec, load, load_vec, max_norm, save_vec, unit

CHUNK = 16 * WIDTH  # rays that a thread claims at a time


def trace_rays(
    next_ray: Any, tree: Tree, origins: Any, directions: Any, distances: Any, owners: Any, points: Any, normals: Any
) -> None:
    """Find the closest hits of n rays, claiming chunks of rays from the counter `next_ray` until none is left.

    Any number of threads may do so at the same time. Reads `origins` and `directions`, (n, 3), which may have any
    length. Writes `points` of hits and `normals`, (n, 3), `distances`, and `owners`, the indices of the shapes in
    `tree`, (n,): NaN, infinity and -1 without a hit.
    """
    count = origins.shape[0]
    memory = packet_memory()
    while True:
        start = fetch_add(next_ray, CHUNK)
        if start >= count:
            return
        for begin in range(start, min(start + CHUNK, count), WIDTH):
            for ray in range(WIDTH):  # lanes behind the last ray repeat it, and are not active
                memory[HIT + ray] = begin + ray
                for axis in range(3):
                    memory[ORIGIN + axis * WIDTH + ray] = origins[min(begin + ray, count - 1), axis]
                    memory[DIRECTION + axis * WIDTH + ray] = directions[min(begin + ray, count - 1), axis]
            origin, direction = load_vec(memory, ORIGIN), unit(rescale(load_vec(memory, DIRECTION)))
            t, owner, _, _ = closest_hit(tree, origin, direction, load(memory, HIT) < count)
            save_vec(origin + t * direction, memory, ORIGIN)
            save_vec(Vec(t, owner, t), memory, HIT)
            for ray in range(min(WIDTH, count - begin)):
                index, point = int(memory[HIT + WIDTH + ray]), vec_at(memory, ORIGIN, ray)
                surface_point, normal = Vec(nan, nan, nan), Vec(nan, nan, nan)
                if index >= 0:
                    surface_point, normal = of_shape(surface, tree.groups, tree.slots[index], (point,), (point, point))
                distances[begin + ray], owners[begin + ray] = memory[HIT + ray], index
                store_vec(points, begin + ray, surface_point)
                store_vec(normals, begin + ray, normal)


def rescale(v: Vec) -> Vec:
    """Scale a vector so that its largest coordinate is 1: its length then neither overflows nor underflows."""
    size = max_norm(v)
    return Vec(v.x / size, v.y / size, v.z / size)
