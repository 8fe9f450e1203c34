"""Culling of infinite planes: the cells of a grid of directions that may meet them, and planes that cannot occlude."""

from __future__ import annotations

import numpy as np

from minirt.kernel.binning import MARGIN, Grid
from minirt.rendering.packing.lights import light_position, radius_of, tangent_of
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.scene import Lamp


def signed_heights(planes: np.ndarray, point: np.ndarray, radius: float = 0.0) -> np.ndarray:
    """Lower bounds of the heights of a ball about a point above planes, (p, 5) as in
    `minirt.rendering.packing.shape_arrays`.

    They are negative below a plane, and 0 where the ball meets it or rounding may decide.
    """
    above = planes[:, :3] @ point - planes[:, 3]
    slack = planes[:, 4] + MARGIN * np.abs(point).max() + radius  # rounding errors, upper bounds of them
    bounds: np.ndarray = np.sign(above) * np.maximum(np.abs(above) - slack, 0.0)
    return bounds


def never_occludes(shape_arrays: ShapeArrays, eye: np.ndarray, light: Lamp, radius: float = 0.0) -> np.ndarray:
    """Whether each plane hides nothing that an eye in a lens of some radius sees from a light; False for transparent
    planes.

    Whatever an eye sees lies on its side of every plane, because the plane hides the rest. So a plane occludes nothing
    if the light is on that side, too, or if parallel light comes from there, whatever the rounding.
    """
    planes = shape_arrays.planes
    heights = signed_heights(planes, eye, radius)
    if light.place:
        harmless = heights * signed_heights(planes, light_position(light), radius_of(light)) > 0
    else:
        slopes = planes[:, :3] @ -np.array(light.cone()[:3])
        harmless = (heights * slopes > 0) & (np.abs(slopes) > MARGIN + tangent_of(light))
    owners = shape_arrays.owner[shape_arrays.plane_indices].tolist()
    glass = [shape_arrays.shapes[owner].glass for owner in owners]
    skipped: np.ndarray = harmless & np.array([each is None or each.share <= 0 for each in glass], bool)
    return skipped


def cell_runs(grid: Grid, normals: np.ndarray, lean: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The runs of cells, each within a row of them, in which planes may be hit: plane, first cell and number of cells.

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
    return plane, row * grid.across + begin.ravel()[nonempty], (end - begin).ravel()[nonempty]
