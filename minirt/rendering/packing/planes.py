"""Culling of infinite planes: the cells of a grid of directions that may meet them, and planes that cannot occlude."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from minirt.kernel.binning import MARGIN, Grid
from minirt.rendering.packing.lights import light_position, radius_of, tangent_of
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.scene import Lamp


class CellRuns(NamedTuple):
    """Runs of cells in which planes may be hit, each within a row of cells."""

    planes: np.ndarray  # (r,) index of the plane
    first: np.ndarray  # (r,) the first cell
    lengths: np.ndarray  # (r,) number of cells


def signed_heights(planes: np.ndarray, point: np.ndarray, radius: float = 0.0) -> np.ndarray:
    """Lower bounds of the heights of a ball about a point above planes, (p, 5) as in
    `minirt.rendering.packing.shape_arrays`.

    They are negative below a plane, and 0 where the ball meets it or rounding may decide.
    """
    above = planes[:, :3] @ point - planes[:, 3]
    slack = rounding(planes, point) + radius
    bounds: np.ndarray = np.sign(above) * np.maximum(np.abs(above) - slack, 0.0)
    return bounds


def rounding(planes: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Upper bounds of the rounding errors of heights of a point above planes."""
    errors: np.ndarray = planes[:, 4] + MARGIN * np.abs(point).max()
    return errors


def same_side(
    planes: np.ndarray, a: np.ndarray, b: np.ndarray, radius_a: float = 0.0, radius_b: float = 0.0
) -> np.ndarray:
    """Whether the balls about both points lie on the same side of each plane, whatever the rounding.

    Such a plane occludes nothing that one point sees from the other: whatever an eye sees lies on its side of every
    plane, because the plane hides the rest.
    """
    same: np.ndarray = signed_heights(planes, a, radius_a) * signed_heights(planes, b, radius_b) > 0
    return same


def never_hit(
    planes: np.ndarray, point: np.ndarray, direction: np.ndarray, radius: float = 0.0, spread: float = 0.0
) -> np.ndarray:
    """Whether rays in a direction, or up to `spread` radians away, that start on the same side of a plane as a ball
    about a point never hit it, for each plane and whatever the rounding."""
    slopes = planes[:, :3] @ direction
    never: np.ndarray = (signed_heights(planes, point, radius) * slopes > 0) & (np.abs(slopes) > MARGIN + spread)
    return never


def never_occludes(shape_arrays: ShapeArrays, eye: np.ndarray, light: Lamp, radius: float = 0.0) -> np.ndarray:
    """Whether each plane hides nothing that an eye in a lens of some radius sees from a light; False for transparent
    planes."""
    if not light.place:
        harmless = never_hit(shape_arrays.planes, eye, -np.array(light.cone()[:3]), radius, tangent_of(light))
    else:
        harmless = same_side(shape_arrays.planes, eye, light_position(light), radius, radius_of(light))
    owners = shape_arrays.owner[shape_arrays.plane_indices].tolist()
    glass = [shape_arrays.shapes[owner].glass for owner in owners]
    skipped: np.ndarray = harmless & np.array([each is None or each.share <= 0 for each in glass], bool)
    return skipped


def cell_runs(grid: Grid, normals: np.ndarray, lean: float = 0.0) -> CellRuns:
    """The runs of cells in which planes may be hit.

    `normals` (p, 3) point towards the planes; 0, 0, 0 stands for everywhere. A direction forward + x across + y down
    hits a plane if its product with the normal, a linear function of the slopes x and y, is positive: a row is tested
    at the edge at which it is greater. Directions may differ by vectors up to `lean`.
    """
    dots = (normals @ grid.frames.reshape(-1, 3).T).reshape(-1, 3, 1)  # of each plane in each frame
    middle_x, middle_y = grid.middle_x - grid.first_column, grid.middle_y - grid.first_row
    edges = (np.arange(grid.down) + np.array([[-grid.margin], [1 + grid.margin]]) - middle_y) / grid.scale_y
    slack = MARGIN * (1 + grid.middle_x / grid.scale_x + grid.middle_y / grid.scale_y) + lean
    most = dots[:, 2] + np.maximum(dots[:, 1] * edges[0], dots[:, 1] * edges[1]) + slack
    nowhere = (dots[:, 0] == 0) & (most <= 0)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # an edge beyond all cells may be infinite
        edge = -most / dots[:, 0]
        low = np.where(dots[:, 0] > 0, edge, np.where(nowhere, np.inf, -np.inf))
        high = np.where(dots[:, 0] < 0, edge, np.where(nowhere, -np.inf, np.inf))
        begin = np.floor(low * grid.scale_x + middle_x - grid.margin)
        end = np.floor(high * grid.scale_x + middle_x + grid.margin) + 1
    begin = np.clip(begin, 0, grid.across).astype(np.int64)
    end = np.clip(end, 0, grid.across).astype(np.int64)
    nonempty = np.flatnonzero(end > begin)
    plane, row = np.divmod(nonempty, len(grid.frames) * grid.down)
    return CellRuns(plane, row * grid.across + begin.ravel()[nonempty], (end - begin).ravel()[nonempty])
