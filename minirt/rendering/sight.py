"""What the eye and the lamps see where: the lists of the kernel's tiles and cubes."""

from __future__ import annotations

import numpy as np

from minirt.kernel.frame import TILE, tiles
from minirt.rendering.cells import Spread, least_distances, lists, rectangles, seen_from, whole_cells

# Right, up and forward of the six faces of a cube, in the order of `minirt.kernel.trace.cell`.
FACES = np.array([np.roll(np.diag([1.0, 1.0, side]), axis + 1, axis=1) for axis in range(3) for side in (1, -1)])
EDGE = 1e-6  # of a cell: rectangles grow by it before they are rounded to cells
GRIDS = ((8, 1), (200, 16), (2_000, 32), (np.inf, 64))  # up to so many shapes, cells along an edge of a lamp's cube

Lists = tuple[np.ndarray, np.ndarray, np.ndarray]  # starts (kinds, cells + 1), members, least distances


def grid_for(shapes: int) -> int:
    """Cells along an edge of the cube around a lamp; 1 where trying all shapes is faster than looking them up."""
    return next(cells for most, cells in GRIDS if shapes <= most)


def seen_by_eye(balls: np.ndarray, kinds: np.ndarray, camera: np.ndarray, width: int, height: int) -> Lists:
    """The shapes in each tile of a picture, by kind."""
    eye, right, up, forward = camera.reshape(4, 3)
    places, radii = seen_from(eye, balls)
    near = least_distances(places, radii)
    order = np.argsort(near, kind="stable")
    wide, high = np.linalg.norm(right), np.linalg.norm(up)
    frame = np.stack([right / wide, up / high, forward])
    left, right_end, bottom, top = rectangles(places, radii, frame[None])[0, order].T
    x = (np.stack([left, right_end]) / wide + 1) * (width / 2)
    y = (1 - np.stack([top, bottom]) / high) * (height / 2)
    across, down = tiles(width), tiles(height)
    column, columns = whole_cells((x[0] - 1) / TILE, (x[1] + 1) / TILE, across)  # a pixel of margin
    row, rows = whole_cells((y[0] - 1) / TILE, (y[1] + 1) / TILE, down)
    first = (kinds[order] * down + row) * across + column
    starts, seen = by_kind(kinds, order, (first, columns, rows), across, across * down)
    return starts, seen, near


def seen_by_lamp(balls: np.ndarray, kinds: np.ndarray, lamp: np.ndarray, grid: int) -> Lists:
    """The shapes in each cell of the cube around a lamp, by kind."""
    places, radii = seen_from(lamp, balls)
    near = least_distances(places, radii)
    order = np.argsort(near, kind="stable")
    if grid == 1:
        one = np.ones(len(order), np.int64)
        starts, lit = by_kind(kinds, order, (kinds[order] * 6, one, one), 1, 6)
        return starts, lit, near
    cells = (rectangles(places, radii, FACES)[:, order] + 1) * (grid / 2)
    column, columns = whole_cells(cells[..., 0] - EDGE, cells[..., 1] + EDGE, grid)
    row, rows = whole_cells(cells[..., 2] - EDGE, cells[..., 3] + EDGE, grid)
    face = np.arange(6)[:, None]
    first = ((kinds[order] * 6 + face) * grid + row) * grid + column
    spread = first.T.ravel(), columns.T.ravel(), rows.T.ravel()  # for each shape its six faces
    starts, lit = by_kind(kinds, np.repeat(order, 6), spread, grid, 6 * grid * grid)
    return starts, lit, near


def by_kind(
    kinds: np.ndarray, order: np.ndarray, spread: Spread, across: int, cells: int
) -> tuple[np.ndarray, np.ndarray]:
    """The lists of a grid for each kind, starts (kinds, cells + 1) and members; the grids of the kinds lie one behind
    the other, and shape `order[i]` covers the cells of `spread` i."""
    count = int(kinds.max()) + 1
    starts, members = lists(spread, across, count * cells)
    windows = np.arange(count)[:, None] * cells + np.arange(cells + 1)
    return starts[windows], order[members]
