"""Culling of planes that are hidden wherever one looks: repeated ones, and those behind parallel ones or behind others.

`minirt.rendering.culling.hidden_planes` culls the rest cell by cell.
"""

from __future__ import annotations

import numpy as np

from minirt.kernel.binning import Grid
from minirt.rendering.culling.dual_hull import within_hull
from minirt.rendering.culling.hidden_planes import COINCIDENT, MOST_WORK, nearest_runs
from minirt.rendering.culling.planes import CellRuns, is_crowd, rounding
from minirt.rendering.packing.shape_arrays import ShapeArrays

FIRST_WORK, PASSES = 2**19, 4  # planes of blocks at least, and of each plane, that are looked at before that
PER_CELL = 32  # planes in a cell on average, from which on those are looked for that are never seen


def seen_planes(
    shape_arrays: ShapeArrays,
    shown: np.ndarray,
    height: np.ndarray,
    origin: np.ndarray,
    grid: Grid,
    hides: np.ndarray,
    radius: float,
) -> tuple[np.ndarray, CellRuns | None]:
    """Return which of the planes that are `shown` (p,) may be seen from a ball, and their runs of cells if known.

    `height` (p,) are the `signed_heights` of the ball; planes hide others where `hides` (p,) is true. Most crowds are
    culled in the cells; only where many are left in each is it worthwhile to look for planes that are never seen.
    """
    planes = shape_arrays.planes
    normals, heights, error = -np.sign(height[:, None]) * planes[:, :3], np.abs(height), 2 * rounding(planes, origin)
    left = np.flatnonzero(shown)
    if not radius:
        work = min(MOST_WORK, max(FIRST_WORK, PASSES * len(left) * len(grid.frames)))
        runs = nearest_runs(grid, normals[left], heights[left], error[left], hides[left], work)
        if runs is not None and runs.lengths.sum() <= PER_CELL * grid.cells:
            return shown, runs
        left = left[~within_hull(normals[left], heights[left], error[left], hides[left], COINCIDENT)]
    left = left[~behind_parallel(normals[left], heights[left], error[left], hides[left], 2 * radius)]
    points = shape_arrays.boxes[shape_arrays.plane_indices[left], :3]
    left = left[~repeated(np.concatenate([planes[left, :3], points], axis=1), hides[left])]
    seen = np.zeros(len(shown), bool)
    seen[left] = True
    if radius or not is_crowd(len(left), grid):
        return seen, None
    return seen, nearest_runs(grid, normals[left], heights[left], error[left], hides[left])


def behind_parallel(
    normals: np.ndarray, heights: np.ndarray, error: np.ndarray, hides: np.ndarray, reach: float
) -> np.ndarray:
    """Whether each plane is behind one with the same normal, as seen from points that are higher by up to `reach`.

    Rays hit both or neither, because the products of their directions with the normals are the same to the last bit.
    """
    if not may_be_alike(normals):
        return np.zeros(len(normals), bool)
    order = np.lexsort(normals.T)
    in_order = normals[order]
    begins = np.flatnonzero(np.append(True, (in_order[1:] != in_order[:-1]).any(axis=1)))
    farthest = np.where(hides & (heights > 0), heights + error + reach, np.inf)[order]
    nearest = np.repeat(np.minimum.reduceat(farthest, begins), np.diff(np.append(begins, len(order))))
    behind = np.zeros(len(heights), bool)
    behind[order] = heights[order] + reach > COINCIDENT * nearest
    return behind & (heights > 0)


def repeated(definitions: np.ndarray, hides: np.ndarray) -> np.ndarray:
    """Whether each plane has the same definition (p, 6) as one with a lower index, both of them hiding others.

    Rays hit both at the same place to the last bit, and where surfaces coincide the one with the lower index is seen.
    """
    if not may_be_alike(definitions):
        return np.zeros(len(definitions), bool)
    order = np.lexsort(definitions.T)  # which leaves equal ones in their order
    in_order, hiding = definitions[order], hides[order]
    again = np.zeros(len(order), bool)
    again[order[1:]] = (in_order[1:] == in_order[:-1]).all(axis=1) & hiding[1:] & hiding[:-1]
    return again


def may_be_alike(rows: np.ndarray) -> bool:
    """Whether two rows (p, n) may be equal. To sort one key takes a tenth of the time of sorting all columns."""
    keys = np.sort(sum(column * factor for column, factor in zip(rows.T, np.sqrt([2, 3, 5, 7, 11, 13]), strict=False)))
    return bool((keys[1:] == keys[:-1]).any())
