"""Culling of planes behind planes: where there are thousands, most are hidden by nearer ones in every cell of a grid.

The reciprocal of a plane's depth is a linear function of the slopes of a direction, so that its least and greatest
values in a block of cells are at the corners. A plane is hidden in a block if another one is nearer at all of them.
"""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

import numpy as np

from minirt.kernel.binning import MARGIN, Grid
from minirt.rendering.culling.planes import CellRuns, cell_runs

SMALL_BLOCK = 2**14  # planes times cells of a block that is not divided any more
BLOCKS = 2**12  # nor is a block of one part in so many of the cells
MOST_WORK = 2**22  # planes of blocks that are looked at, before culling is given up
COINCIDENT = 1 + 2.0**-12  # depths whose ratio is less are taken to be equal: the sort keys of depths are that coarse


class Block(NamedTuple):
    """A rectangle of the cells of a frame, and the planes that may be seen in it."""

    frame: int
    column: int
    row: int
    columns: int
    rows: int
    planes: np.ndarray


def nearest_runs(
    grid: Grid,
    normals: np.ndarray,
    heights: np.ndarray,
    error: np.ndarray,
    hides: np.ndarray,
    most_work: int = MOST_WORK,
) -> CellRuns | None:
    """Return runs as `cell_runs`, without planes that others hide from the origin of the grid; None if it takes long.

    `normals` (p, 3) point towards the planes, and `heights` (p,) are the least distances to them, too small by up to
    `error` (p,); planes hide others where `hides` (p,) is true.
    """
    everything, by_axis = np.arange(len(normals)), np.ascontiguousarray(normals.T)
    blocks = deque(Block(frame, 0, 0, grid.across, grid.down, everything) for frame in range(len(grid.frames)))
    runs, work = [], 0
    while blocks:
        block = blocks.popleft()
        kept = unhidden(grid, block, by_axis, heights, error, hides)
        cells, work = block.columns * block.rows, work + len(block.planes)
        if work > most_work:
            return None
        if cells <= max(1, grid.cells // BLOCKS) or cells * len(kept) <= SMALL_BLOCK:
            runs.append(runs_of_block(grid, block, normals, kept))
        else:
            blocks += quarters(block._replace(planes=kept))
    return CellRuns(*(np.concatenate(each) for each in zip(*runs, strict=True)))


def unhidden(
    grid: Grid, block: Block, by_axis: np.ndarray, heights: np.ndarray, error: np.ndarray, hides: np.ndarray
) -> np.ndarray:
    """Return the planes of a block that no other one hides in all of its cells; `by_axis` (3, p) are the normals."""
    ends_x = np.array([block.column - grid.margin, block.column + block.columns + grid.margin])
    ends_y = np.array([block.row - grid.margin, block.row + block.rows + grid.margin])
    x = (ends_x + grid.first_column - grid.middle_x) / grid.scale_x
    y = (ends_y + grid.first_row - grid.middle_y) / grid.scale_y
    corners = np.array([[across, down, 1.0] for across in x for down in y]) @ grid.frames[block.frame]
    planes = block.planes
    slack = MARGIN * (1 + np.abs(corners).sum())
    slopes = corners @ by_axis[:, planes]
    greatest, least = slopes.max(axis=0) + slack, slopes.min(axis=0) - slack
    farthest = np.where(hides[planes], least / np.maximum(heights[planes] + error[planes], 1e-300), -np.inf)
    hider = farthest.argmax()
    with np.errstate(divide="ignore"):  # a plane at the origin is seen everywhere
        kept = np.flatnonzero((greatest > 0) & (greatest / heights[planes] * COINCIDENT >= max(farthest[hider], 0.0)))
        if farthest[hider] > -np.inf:
            nearest = (slopes[:, kept] + slack) / heights[planes[kept]]
            depths = (slopes[:, hider] - slack) / (heights[planes[hider]] + error[planes[hider]])
            kept = kept[(nearest * COINCIDENT >= depths[:, None]).any(axis=0)]
    seen: np.ndarray = planes[kept]
    return seen


def quarters(block: Block) -> list[Block]:
    """Divide a block along its edges of more than one cell."""
    across, down = -(-block.columns // 2), -(-block.rows // 2)
    return [
        Block(block.frame, column, row, min(across, right - column), min(down, below - row), block.planes)
        for right, below in [(block.column + block.columns, block.row + block.rows)]
        for column in range(block.column, right, across)
        for row in range(block.row, below, down)
    ]


def runs_of_block(grid: Grid, block: Block, normals: np.ndarray, kept: np.ndarray) -> CellRuns:
    """Return the runs of some planes in a block as those of the whole grid."""
    part = grid._replace(
        frames=grid.frames[block.frame : block.frame + 1],
        across=block.columns,
        down=block.rows,
        first_column=grid.first_column + block.column,
        first_row=grid.first_row + block.row,
    )
    plane, cell, columns = cell_runs(part, normals[kept])
    row, column = np.divmod(cell, block.columns)
    first = (block.frame * grid.down + block.row + row) * grid.across + block.column + column
    return CellRuns(kept[plane], first, columns)
