"""Endless planes in a grid of directions: which cells may meet them, and between which points none of them lies."""

from __future__ import annotations

import numpy as np

from minirt.kernel.culling.binning import MARGIN, Grid
from minirt.rendering.packing.lights import light_position
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.scene import Lamp, ParallelLight
from minirt.shapes import Shape


def signed_heights(planes: np.ndarray, point: np.ndarray) -> np.ndarray:
    """How far above planes, (p, 5) as in `minirt.rendering.packing.shape_arrays`, a point is at least; below them less than zero, and
    zero where rounding may decide."""
    above = planes[:, :3] @ point - planes[:, 3]
    slack = planes[:, 4] + MARGIN * np.abs(point).max()
    least: np.ndarray = np.sign(above) * np.maximum(np.abs(above) - slack, 0.0)
    return least


def same_side(planes: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Which planes have both points on the same side, whatever the rounding.

    Such a plane hides nothing that the one sees from the other: whatever an eye sees lies on its side of every plane,
    because the plane hides the rest.
    """
    same: np.ndarray = signed_heights(planes, a) * signed_heights(planes, b) > 0
    return same


def never_hit(planes: np.ndarray, point: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Which planes rays in a direction never meet that start on the side where a point is, whatever the rounding."""
    slopes = planes[:, :3] @ direction
    never: np.ndarray = (signed_heights(planes, point) * slopes > 0) & (np.abs(slopes) > MARGIN)
    return never


def never_occludes(tables: ShapeArrays, eye: np.ndarray, lamp: Lamp) -> np.ndarray:
    """Which planes hide nothing that the eye sees from a lamp; never those that the eye sees through."""
    if isinstance(lamp, ParallelLight):
        found = never_hit(tables.planes, eye, -np.array(lamp.direction))
    else:
        found = same_side(tables.planes, eye, light_position(lamp))
    opaque = np.array([not is_transparent(tables.shapes[i]) for i in tables.owner[tables.flat].tolist()], bool)
    skipped: np.ndarray = found & opaque
    return skipped


def is_transparent(shape: Shape) -> bool:
    """Whether light goes through it."""
    return shape.glass is not None and shape.glass.share > 0


def cell_runs(grid: Grid, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Runs of cells in which planes may be met: plane, first cell and how many of the same row. `normals` (p, 3) point
    towards the planes; one of 0, 0, 0 stands for everywhere.

    A direction forward + x across + y down meets a plane if its product with the normal, a linear function of the
    slopes x and y, is above zero: a row is tried at that of its edges where it is greater.
    """
    to = (normals @ grid.frames.reshape(-1, 3).T).reshape(-1, 3, 1)  # of each plane in each frame
    edges = (np.arange(grid.down) + np.array([[-grid.margin], [1 + grid.margin]]) - grid.middle_y) / grid.scale_y
    slack = MARGIN * (1 + grid.middle_x / grid.scale_x + grid.middle_y / grid.scale_y)
    most = to[:, 2] + np.maximum(to[:, 1] * edges[0], to[:, 1] * edges[1]) + slack
    with np.errstate(divide="ignore", invalid="ignore"):
        edge = -most / to[:, 0]
    nowhere = (to[:, 0] == 0) & (most <= 0)
    low = np.where(to[:, 0] > 0, edge, np.where(nowhere, np.inf, -np.inf))
    high = np.where(to[:, 0] < 0, edge, np.where(nowhere, -np.inf, np.inf))
    begin = np.clip(np.floor(low * grid.scale_x + grid.middle_x - grid.margin), 0, grid.across).astype(np.int64)
    end = np.clip(np.floor(high * grid.scale_x + grid.middle_x + grid.margin), -1, grid.across - 1).astype(np.int64) + 1
    there = np.flatnonzero(end > begin)
    plane, row = np.divmod(there, len(grid.frames) * grid.down)
    return plane, row * grid.across + begin.ravel()[there], (end - begin).ravel()[there]
