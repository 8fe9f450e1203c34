"""Packs the lens of a camera: a disc in the image plane, through whose points the eye looks at what is in focus."""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np

from minirt.kernel.scene_arrays import kind_of
from minirt.lanes import Vec
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.scene import Camera
from minirt.scene.camera_frame import camera_frame

CLOSEST = 2.0**-60  # least distance of what is in focus, in radii of the lens: squares of directions stay finite
SMALLEST = 2.0**-100  # least such distance, in scene units: its reciprocal is finite in single precision, too


def lens_numbers(camera: Camera, focus: float) -> np.ndarray:
    """The half axes of the lens, to the right and up, and one over the distance of what is in focus, (7,).

    A distance that is too small for arithmetic is replaced by the least that is not."""
    right, up, _ = camera_frame(camera)
    radius = (camera.lens or 0.0) / 2
    nearest = max(focus, radius * CLOSEST, SMALLEST)
    return np.array([*(radius * x for x in right), *(radius * x for x in up), 1.0 / nearest])


def radius_and_focus(lens: np.ndarray | None) -> tuple[float, float]:
    """The radius of a lens, and one over the distance of what is in focus; 0 and 0 without a lens."""
    return (0.0, 0.0) if lens is None else (float(np.linalg.norm(lens[:3])), float(lens[6]))


def distance_in_the_middle(shape_arrays: ShapeArrays, camera: np.ndarray) -> float:
    """The distance of the shape in the middle of the picture; infinite without one."""
    with np.errstate(all="ignore"):
        return float(hit_distances(shape_arrays, Vec(*camera[:3]), Vec(*camera[9:12])).min(initial=inf))


def hit_distances(shape_arrays: ShapeArrays, origin: Vec, direction: Vec) -> np.ndarray:
    """The distances at which a ray hits each primitive, infinite where it does not."""
    distance = np.full(len(shape_arrays.slots), inf)
    for group, rows in enumerate(shape_arrays.rows):
        hit, t = kind_of(rows.dtype.names).intersect(packed_columns(rows), origin, direction)
        distance[shape_arrays.slots[:, 0] == group] = np.where(hit, t, inf)
    return distance


def packed_columns(rows: Any) -> Any:
    """Pack rows of shapes of one kind as one shape whose numbers are arrays."""
    parts = (rows[name] for name in rows.dtype.names)
    return kind_of(rows.dtype.names).packed(*(Vec(*part.T) if part.ndim > 1 else part for part in parts))
