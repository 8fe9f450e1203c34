"""Triangles of meshes, indexed by their corners: moving a mesh writes its points and the normals of their planes."""

from __future__ import annotations

from typing import Any

from minirt.kernel.bvh_nodes import WIDTH, packet_memory, vec_at
from minirt.kernel.pixels import fetch_add
from minirt.kernel.scene_arrays import scaled, store_vec, turned, vector
from minirt.lanes import Vec, load_vec, save_vec
from minirt.shapes.plane_normals import plane_normal_towards

CHUNK = 4096  # points, and triangles, that a thread places at once: a multiple of `WIDTH`
SCALE, POSITION = 9, 10  # offsets in the numbers of a place, behind the turn


def placed(place: Any, point: Vec) -> Vec:
    """Transform points of a file into the scene, rounded as by `minirt.shapes.mesh.Mesh.placed`."""
    return scaled(turned(place, point), place[SCALE]) + vector(place, POSITION)


def place_triangles(
    next_chunk: Any, place: Any, source: Any, flat: Any, first: int, corners: Any, points: Any, normals: Any
) -> None:
    """Write the points of a mesh and the normals of its triangles, taking chunks from the counter `next_chunk` until
    none is left.

    Any number of threads may do so at the same time. `place` has the turn, the scale and the position of the mesh,
    `source` (n, 3) and `flat` (m, 3) are points and approximate normals in its file, and the first of its points has
    the number `first` in `corners` (m, 3).
    """
    memory, count = packet_memory(), corners.shape[0]
    while True:
        start = fetch_add(next_chunk, CHUNK)
        if start >= max(source.shape[0], count):
            return
        for i in range(start, min(start + CHUNK, source.shape[0])):
            store_vec(points, i, placed(place, vector(source[i], 0)))
        for begin in range(start, min(start + CHUNK, count), WIDTH):
            for lane in range(WIDTH):
                row = min(begin + lane, count - 1)
                for axis in range(3):
                    for corner in range(3):
                        memory[(3 * corner + axis) * WIDTH + lane] = source[corners[row, corner] - first, axis]
                    memory[(9 + axis) * WIDTH + lane] = flat[row, axis]
            a, b = placed(place, load_vec(memory, 0)), placed(place, load_vec(memory, 3 * WIDTH))
            c, side = placed(place, load_vec(memory, 6 * WIDTH)), turned(place, load_vec(memory, 9 * WIDTH))
            save_vec(plane_normal_towards(a, b, c, side), memory, 0)
            for lane in range(min(WIDTH, count - begin)):
                store_vec(normals, begin + lane, vec_at(memory, 0, lane))
