"""Picking: the shape that a pixel shows and the point on it, by the interpreted formulas of the kernel, for one ray and
all shapes of a kind at once."""

from __future__ import annotations

from typing import Any

import numpy as np

from minirt.fields import Triple
from minirt.kernel import interpreted
from minirt.kernel.frame import ray_direction, tile_count
from minirt.kernel.pixels import TILE
from minirt.kernel.trace import COINCIDENT, closest_hit
from minirt.lanes import Vec, lane, splat, unit
from minirt.rendering.packing.camera import camera_numbers, hit_distances, pixel_rays
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.queries.silhouette import covered_pixels
from minirt.rendering.scene_packing import Packing
from minirt.scene import Camera, Scene
from minirt.shapes import ALL_KINDS, Shape
from minirt.shapes.mesh import Mesh


def pick(
    scene: Scene, width: int, height: int, x: int, y: int, shape_arrays: ShapeArrays | None = None
) -> Shape | None:
    """The shape at the centre of pixel x, y of a picture of that size; None where the background is.

    `shape_arrays` are brought up to date; those of the last picture save the time of packing the shapes.
    """
    shape_arrays = shape_arrays or ShapeArrays()
    shape_arrays.update(scene.shapes)
    camera = pixel_rays(camera_numbers(scene.camera, width, height), width, height)
    origin, direction = Vec(*camera[:3]), unit(ray_direction(camera, x + 0.5, y + 0.5))
    with np.errstate(all="ignore"):
        nearest = nearest_primitives(shape_arrays, origin, direction)
        owners = np.unique(shape_arrays.owner[nearest])
        if len(owners) < 2:
            return shape_arrays.shapes[int(owners[0])] if len(owners) else None
        # Surfaces that may coincide: let the kernel's rule decide.
        parts = [
            shape_arrays.shapes[each].some(
                nearest[shape_arrays.owner[nearest] == each] - shape_arrays.first_primitive[each]
            )
            for each in owners
        ]
        packing = Packing(interpreted)
        arrays = packing.pack(Scene((scene.camera, *parts), scene.file), width, height)
        rays = Vec(*(splat(part, camera) for part in (direction.x, direction.y, direction.z)))
        _, owner, _ = closest_hit(arrays, y // TILE * tile_count(width) + x // TILE, origin, rays)
    return shape_arrays.shapes[int(owners[packing.shape_arrays.owner[int(lane(owner, 0))]])]


def surface_point(shape: Shape, camera: Camera, width: int, height: int, x: int, y: int) -> Triple | None:
    """The point of a shape at the centre of pixel x, y; None where the shape is not there."""
    hit, t, origin, direction = pixel_hits(shape, camera, width, height, x, y)
    point = origin + float(t) * direction
    return (float(point.x), float(point.y), float(point.z)) if hit else None


def surface_normal(shape: Shape, point: Triple, direction: Triple) -> Triple:
    """The unit normal of a shape at a point of its surface, towards where a ray of this direction comes from."""
    kind = next(kind for kind in ALL_KINDS if kind.element is type(shape))
    with np.errstate(all="ignore"):
        if isinstance(shape, Mesh):
            hit, t = kind.intersect(shape.pack(), Vec(*point) - Vec(*direction), Vec(*direction))
            shape = shape.some(np.array([np.argmin(np.where(hit, abs(t - 1.0), np.inf))]))
        _, normal = kind.surface(shape.pack(), Vec(*point))
    x, y, z = (float(np.ravel(part)[0]) for part in (normal.x, normal.y, normal.z))
    facing = -1.0 if x * direction[0] + y * direction[1] + z * direction[2] > 0 else 1.0
    return facing * x + 0.0, facing * y + 0.0, facing * z + 0.0


def covers(shape: Shape, camera: Camera, width: int, height: int, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Whether a shape covers the centres of pixels x, y, with no other shape in front; False everywhere for a mesh that
    reaches beside or behind the eye."""
    if isinstance(shape, Mesh):
        covered = covered_pixels(shape, camera, width, height)
        inside = (x >= 0) & (x < width) & (y >= 0) & (y < height)
        return inside & (covered is not None and covered[np.clip(y, 0, height - 1), np.clip(x, 0, width - 1)])
    return np.broadcast_to(pixel_hits(shape, camera, width, height, x, y)[0], x.shape)


def pixel_hits(shape: Shape, camera: Camera, width: int, height: int, x: Any, y: Any) -> tuple[Any, Any, Vec, Vec]:
    """Whether and where rays through pixels hit a shape, their origin and directions; for a mesh, only one ray."""
    numbers = pixel_rays(camera_numbers(camera, width, height), width, height)
    kind = next(kind for kind in ALL_KINDS if kind.element is type(shape))
    with np.errstate(all="ignore"):
        origin, direction = Vec(*numbers[:3]), unit(ray_direction(numbers, x + 0.5, y + 0.5))
        hit, t = kind.intersect(shape.pack(), origin, direction)
        if isinstance(shape, Mesh):
            hit, t = hit.any(), np.where(hit, t, np.inf).min()
        return hit, t, origin, direction


def nearest_primitives(shape_arrays: ShapeArrays, origin: Vec, direction: Vec) -> np.ndarray:
    """Indices of the nearest primitive that a ray hits, and of those so close behind that they may coincide with it."""
    distance = hit_distances(shape_arrays, origin, direction)
    least = distance.min(initial=np.inf)
    return np.flatnonzero(np.isfinite(distance) & (distance <= least * (1 + 2 * COINCIDENT)))
