"""Culling of infinite planes: the cells of a grid of directions that may meet them, and planes that cannot occlude."""

from __future__ import annotations

import numpy as np

from minirt.kernel.culling.binning import MARGIN, Grid
from minirt.rendering.packing.lights import light_position
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.scene import Lamp, ParallelLight
from minirt.shapes import Shape


def signed_heights(planes: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Lower bounds of the heights of a point above planes, (p, 5) as in `minirt.rendering.packing.shape_arrays`.

    They are negative below a plane, and 0 where rounding may decide.
    """
    above = planes[:, :3] @ point - planes[:, 3]
    slack = planes[:, 4] + MARGIN * np.abs(point).max()
    bounds: np.ndarray = np.sign(above) * np.maximum(np.abs(above) - slack, 0.0)
    return bounds


def same_side(planes: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Whether both points lie on the same side of each plane, whatever the rounding.

    Such a plane occludes nothing that one point sees from the other: whatever an eye sees lies on its side of every
    plane, because the plane hides the rest.
    """
    same: np.ndarray = signed_heights(planes, a) * signed_heights(planes, b) > 0
    return same


def never_hit(planes: np.ndarray, point: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Whether rays in a direction that start on the same side of a plane as a point never hit it, for each plane and
    whatever the rounding."""
    slopes = planes[:, :3] @ direction
    never: np.ndarray = (signed_heights(planes, point) * slopes > 0) & (np.abs(slopes) > MARGIN)
    return never


def never_occludes(shape_arrays: ShapeArrays, eye: np.ndarray, light: Lamp) -> np.ndarray:
    """Whether each plane hides nothing that the eye sees from a light; False for transparent planes."""
    if isinstance(light, ParallelLight):
        harmless = never_hit(shape_arrays.planes, eye, -np.array(light.direction))
    else:
        harmless = same_side(shape_arrays.planes, eye, light_position(light))
    owners = shape_arrays.owner[shape_arrays.plane_indices].tolist()
    opaque = np.array([not is_transparent(shape_arrays.shapes[owner]) for owner in owners], bool)
    skipped: np.ndarray = harmless & opaque
    return skipped


def is_transparent(shape: Shape) -> bool:
    """Whether light passes through a shape."""
    return shape.glass is not None and shape.glass.share > 0


def cell_runs(grid: Grid, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Runs of cells in which planes may be hit: the plane, the first cell and the number of cells of the same row.

    `normals` (p, 3) point towards the planes; 0, 0, 0 stands for everywhere. A direction forward + x across + y down
    hits a plane if its product with the normal, a linear function of the slopes x and y, is positive: a row is tested
    at the edge at which it is greater.
    """
    dots = (normals @ grid.frames.reshape(-1, 3).T).reshape(-1, 3, 1)  # of each plane in each frame
    edges = (np.arange(grid.down) + np.array([[-grid.margin], [1 + grid.margin]]) - grid.middle_y) / grid.scale_y
    slack = MARGIN * (1 + grid.middle_x / grid.scale_x + grid.middle_y / grid.scale_y)
    most = dots[:, 2] + np.maximum(dots[:, 1] * edges[0], dots[:, 1] * edges[1]) + slack
    nowhere = (dots[:, 0] == 0) & (most <= 0)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # an edge beyond all cells may be infinite
        edge = -most / dots[:, 0]
        low = np.where(dots[:, 0] > 0, edge, np.where(nowhere, np.inf, -np.inf))
        high = np.where(dots[:, 0] < 0, edge, np.where(nowhere, -np.inf, np.inf))
        begin = np.floor(low * grid.scale_x + grid.middle_x - grid.margin)
        end = np.floor(high * grid.scale_x + grid.middle_x + grid.margin) + 1
    begin = np.clip(begin, 0, grid.across).astype(np.int64)
    end = np.clip(end, 0, grid.across).astype(np.int64)
    nonempty = np.flatnonzero(end > begin)
    plane, row = np.divmod(nonempty, len(grid.frames) * grid.down)
    return plane, row * grid.across + begin.ravel()[nonempty], (end - begin).ravel()[nonempty]
