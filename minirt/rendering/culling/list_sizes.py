"""Estimates of the memory that lists of shapes take, before they are built."""

from __future__ import annotations

from typing import Any

import numpy as np

from minirt.helpers import system
from minirt.kernel.binning import Grid
from minirt.rendering.culling.planes import CellRuns
from minirt.rendering.packing.shape_arrays import ShapeArrays

MEMBER, START = 4, 8  # bytes of a member and of a start of a list
COARSEST = 16  # cells along an edge of a light buffer that memory limits
QUICKLY_BUILT = 2**29  # bytes of lists that are built within seconds
WHAT = "the lists of shapes in view need"
ADVICE = "fewer or smaller shapes, or fewer lights, need less"
RUN = 120  # bytes of a plane in a row of cells, while its runs are computed
SAMPLE = 128  # shapes whose members are counted for an estimate


def check_lists(
    kernel: Any,
    shape_arrays: ShapeArrays,
    balls: np.ndarray,
    origin: np.ndarray,
    grid: Grid,
    copies: int,
    largest: int,
    planes: int,
    runs: CellRuns | None = None,
) -> None:
    """Check that there is memory for the lists of all cells, and copies of them, and that they have at most `largest`
    bytes; `TooLargeError` otherwise. Where the `runs` of the planes are not known, each is in half of the cells."""
    shapes, kinds = len(shape_arrays.slots), len(shape_arrays.rows)
    of_planes = planes * len(grid.frames) * grid.down if runs is None else len(runs.lengths)
    fixed = copies * kinds * (grid.cells + 1) * START + of_planes * RUN
    if system.is_small_need(fixed + copies * shapes * grid.cells * MEMBER):
        return
    members = planes * grid.cells / 2 if runs is None else float(runs.lengths.sum())
    if len(grid.frames) > 1 or grid.elsewhere >= 0:  # tiles, which are binned for every picture, are not estimated
        members += estimated_members(kernel, shape_arrays, balls, origin, grid)
    system.check_memory(int(fixed + copies * members * MEMBER), WHAT, ADVICE, largest)


def estimated_members(
    kernel: Any, shape_arrays: ShapeArrays, balls: np.ndarray, origin: np.ndarray, grid: Grid
) -> float:
    """Estimate the members of the lists of all cells, infinite planes left out, from those of some shapes."""
    shapes = len(shape_arrays.slots)
    chosen = np.unique(np.linspace(0, shapes - 1, min(SAMPLE, shapes)).astype(np.int64))
    begins, ends = shape_arrays.first_ball[chosen], shape_arrays.first_ball[chosen + 1]
    first = np.concatenate([[0], np.cumsum(ends - begins)]).astype(shape_arrays.first_ball.dtype)
    kept = np.concatenate([balls[begin:end] for begin, end in zip(begins, ends, strict=True)])
    counts = np.zeros(len(shape_arrays.rows) * (grid.cells + 1), np.int64)
    rectangles = np.empty((len(chosen) * max(len(grid.frames), 2), 4), np.int32)
    cones = np.zeros((len(chosen), 5))
    kernel.project_all(origin, grid, kept, 0.0, first, shape_arrays.slots[chosen], rectangles, 0, cones, counts)
    return int(counts.sum()) / len(chosen) * shapes
