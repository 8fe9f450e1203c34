"""Casts single rays by the interpreted formulas of the kernel, where a BVH or the compiler would take longer.

It serves clicks, the focus in the middle of the picture, a shape's fall to the floor, outlines and the search for a
camera that shows the scene. Each call of a formula tests rays (m,) against shapes of one kind (n, 1).
"""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np

from minirt.kernel.frame import ray_direction
from minirt.kernel.scene_arrays import kind_of, kind_of_packed
from minirt.lanes import Vec, unit
from minirt.rendering.packing.camera import pixel_rays
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.scene import Camera
from minirt.shapes import Shape
from minirt.shapes.mesh import Mesh

CHUNK = 1024  # shapes that are tested at once, so that their numbers fit a processor's cache


def camera_ray(camera: Camera, width: int, height: int, x: Any, y: Any) -> tuple[Vec, Vec]:
    """Return origin and directions of rays through places of a picture, in pixels from its upper left corner."""
    numbers = pixel_rays(camera, width, height)
    with np.errstate(all="ignore"):
        return Vec(*numbers[:3]), unit(ray_direction(numbers, x, y))


def packed_columns(rows: Any, *extra: int) -> Any:
    """Pack rows of shapes of one kind as one shape whose numbers are arrays (n, *extra), each of `extra` being 1."""
    parts = (rows[name] for name in rows.dtype.names)
    return kind_of(rows.dtype.names).packed(
        *(
            Vec(*(each.reshape(-1, *extra) for each in part.T)) if part.ndim > 1 else part.reshape(-1, *extra)
            for part in parts
        )
    )


def cast(packed: Any, origin: Vec, direction: Vec, limit: float | None = None) -> np.ndarray:
    """Return the distances at which rays hit packed shapes, infinite where they do not; with an infinite `limit` only
    which are infinite is right, in half of the time."""
    with np.errstate(all="ignore"):
        hit, t = kind_of_packed(type(packed)).intersect(packed, origin, direction, limit)
        return np.where(hit, t, inf)


def distances_of(shape: Shape, origin: Vec, direction: Vec) -> np.ndarray:
    """Return the distances at which rays hit a shape, infinite where they do not."""
    if not isinstance(shape, Mesh):
        return cast(shape.pack(), origin, direction)
    arrays = ShapeArrays()
    arrays.update((shape,))
    return nearest_hits(arrays, origin, direction)[0]


def hit_distances(arrays: ShapeArrays, origin: Vec, direction: Vec) -> np.ndarray:
    """Return the distances at which one ray hits each primitive, infinite where it does not."""
    distance = np.full(len(arrays.slots), inf)
    for group, rows in enumerate(arrays.rows):
        distance[arrays.primitives_of(group)] = cast(packed_columns(rows), origin, direction)
    return distance


def nearest_hits(arrays: ShapeArrays, origin: Vec, direction: Vec) -> tuple[np.ndarray, np.ndarray]:
    """Return the distances of the primitives that rays hit first, and their indices; infinity and -1 where a ray hits
    none. Origins and directions broadcast, and the results have the shape of all rays."""
    shape = np.broadcast(origin.x, origin.y, origin.z, direction.x, direction.y, direction.z).shape
    nearest, found = np.full(shape, inf), np.full(shape, -1)
    of_rays = (1,) * len(shape)  # axes of the rays, behind that of the primitives
    for group, rows in enumerate(arrays.rows):
        primitives = arrays.primitives_of(group)
        for start in range(0, len(rows), CHUNK):
            t = cast(packed_columns(rows[start : start + CHUNK], *of_rays), origin, direction)
            t = np.broadcast_to(t, (len(t), *shape))
            least = t.min(axis=0)
            closer = least < nearest
            nearest = np.where(closer, least, nearest)
            found = np.where(closer, primitives[start + t.argmin(axis=0)], found)
    return nearest, found
