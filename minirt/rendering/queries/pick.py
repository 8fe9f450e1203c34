"""Which shape a pixel shows, and where: the formulas of the kernel, interpreted, for one ray and all shapes of a kind
at once."""

from __future__ import annotations

from typing import Any

import numpy as np

from minirt.fields import Triple
from minirt.kernel.culling import binning
from minirt.kernel.frame import TILE, ray_direction, tile_count
from minirt.kernel.rows import kind_of
from minirt.kernel.trace import COINCIDENT, closest_hit
from minirt.lanes import Vec, lane, splat, unit
from minirt.rendering.packing.camera import camera_numbers, pixel_rays
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.queries.silhouette import covered
from minirt.rendering.scene_packing import Packing
from minirt.scene import Camera, Scene
from minirt.shapes import ALL_KINDS, Shape
from minirt.shapes.mesh import Mesh


def pick(scene: Scene, width: int, height: int, x: int, y: int, tables: ShapeArrays | None = None) -> Shape | None:
    """The shape in the middle of pixel x, y of a picture of that size, or None where there is none.

    `tables` are brought up to date; those of the last picture save the time of making them.
    """
    tables = tables or ShapeArrays()
    tables.update(scene.shapes)
    camera = pixel_rays(camera_numbers(scene.camera, width, height), width, height)
    origin, direction = Vec(*camera[:3]), unit(ray_direction(camera, x + 0.5, y + 0.5))
    with np.errstate(all="ignore"):
        near = in_front(tables, origin, direction)
        owners = np.unique(tables.owner[near])
        if len(owners) < 2:
            return tables.shapes[int(owners[0])] if len(owners) else None
        # Surfaces that may coincide: the kernel has a rule for them.
        parts = [tables.shapes[each].some(near[tables.owner[near] == each] - tables.start[each]) for each in owners]
        packing = Packing(binning)
        traced = packing.pack(Scene((scene.camera, *parts), scene.file), width, height)
        rays = Vec(*(splat(part, camera) for part in (direction.x, direction.y, direction.z)))
        _, owner, _ = closest_hit(traced, y // TILE * tile_count(width) + x // TILE, origin, rays)
    return tables.shapes[int(owners[packing.tables.owner[int(lane(owner, 0))]])]


def place(shape: Shape, camera: Camera, width: int, height: int, x: int, y: int) -> Triple | None:
    """Where in the scene the middle of pixel x, y is on a shape; None where it is not on it."""
    hit, t, origin, direction = met(shape, camera, width, height, x, y)
    point = origin + float(t) * direction
    return (float(point.x), float(point.y), float(point.z)) if hit else None


def covers(shape: Shape, camera: Camera, width: int, height: int, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Whether the middles of pixels x, y show a shape where nothing is in front of it; nowhere for a mesh that reaches
    beside or behind the eye."""
    if isinstance(shape, Mesh):
        found = covered(shape, camera, width, height)
        there = (x >= 0) & (x < width) & (y >= 0) & (y < height)
        return there & (found is not None and found[np.clip(y, 0, height - 1), np.clip(x, 0, width - 1)])
    return np.broadcast_to(met(shape, camera, width, height, x, y)[0], x.shape)


def met(shape: Shape, camera: Camera, width: int, height: int, x: Any, y: Any) -> tuple[Any, Any, Vec, Vec]:
    """Whether and where the rays of pixels meet a shape, their origin and their directions; of a mesh, a single ray."""
    numbers = pixel_rays(camera_numbers(camera, width, height), width, height)
    kind = next(kind for kind in ALL_KINDS if kind.element is type(shape))
    with np.errstate(all="ignore"):
        origin, direction = Vec(*numbers[:3]), unit(ray_direction(numbers, x + 0.5, y + 0.5))
        hit, t = kind.intersect(shape.pack(), origin, direction)
        if isinstance(shape, Mesh):
            hit, t = hit.any(), np.where(hit, t, np.inf).min()
        return hit, t, origin, direction


def in_front(tables: ShapeArrays, origin: Vec, direction: Vec) -> np.ndarray:
    """Of the parts that a ray hits the nearest, and those so close to it that they may be in the same place."""
    distance = np.full(len(tables.slots), np.inf)
    for group, rows in enumerate(tables.rows):
        hit, t = kind_of(rows.dtype.names).intersect(columns(rows), origin, direction)
        distance[tables.slots[:, 0] == group] = np.where(hit, t, np.inf)
    least = distance.min(initial=np.inf)
    return np.flatnonzero(np.isfinite(distance) & (distance <= least * (1 + 2 * COINCIDENT)))


def columns(rows: Any) -> Any:
    """All packed shapes of a kind as one whose numbers are arrays."""
    parts = (rows[name] for name in rows.dtype.names)
    return kind_of(rows.dtype.names).packed(*(Vec(*part.T) if part.ndim > 1 else part for part in parts))
