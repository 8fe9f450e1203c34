"""What the eye and the lamps see where: the lists of the kernel's tiles and cubes."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.culling.binning import MARGIN, Grid
from minirt.kernel.frame import TILE, tile_count
from minirt.rendering.culling.light_frustum import SPREAD, Cluster, square_ahead
from minirt.rendering.culling.planes import heights, runs
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.shapes import Shape
from minirt.shapes.mesh import Mesh

# Across, down and forward of the six faces of a cube, in the order of `minirt.kernel.culling.light_buffer.cube_cell`.
FACES = np.array([np.roll(np.diag([1.0, 1.0, side]), axis + 1, axis=1) for axis in range(3) for side in (1, -1)])
# By how many cells a cube's intervals grow for that: at the corner of a face, where slopes change most with the angle,
# an angle e changes them by less than 3 e.
EDGE = 3 * SPREAD * np.pi / 4
# Up to so many shapes, cells along an edge of a lamp's cube, where building and using the lists was seen to take least.
# Of the triangles of a mesh, which lie side by side, a few count, and of the others one in so many.
SMALL = 8
FEW, SIDE_BY_SIDE = 200, 8
GRIDS = ((SMALL, 1), (30, 16), (200, 32), (20_000, 64), (50_000, 128), (500_000, 256), (np.inf, 512))

# Numbers above zero are in the order of their bits, the exponent first. The order of depth knows of those of a distance
# the upper 25, from 2^-128 on: a distance to 2^-13 of it, which is more than `minirt.kernel.trace.COINCIDENT`.
DROPPED = 39
NEAREST = (1023 - 128) << (52 - DROPPED)

NO_CELLS = np.zeros(11)  # around a lamp


class Lists(NamedTuple):
    """What may be met in each cell: `members[starts[kind, cell]:starts[kind, cell + 1]]`, the nearest first."""

    tile_starts: np.ndarray  # (kinds, cells + 1)
    members: np.ndarray
    cones: np.ndarray  # (n, 5) as in `minirt.kernel.scene_arrays`
    light_buffers: np.ndarray = NO_CELLS  # (11,)


def grid_for(tables: ShapeArrays) -> int:
    """Cells along an edge of the cube around a lamp; 1 where trying all shapes is faster than looking them up."""
    shapes = sum(weight(kind, len(rows)) for kind, rows in zip(tables.numbers, tables.rows, strict=True))
    return next(cells for most, cells in GRIDS if shapes <= most)


def weight(kind: type[Shape], parts: int) -> int:
    """For how many shapes the parts of some shapes of a kind count."""
    return min(parts, FEW + parts // SIDE_BY_SIDE) if kind is Mesh else parts


def around(grid: int, ahead: Grid | None) -> np.ndarray:
    """How directions are sorted into cells, for the kernel: see `minirt.kernel.culling.light_buffer`."""
    if ahead is None:
        spread = 2 * np.sin(SPREAD * np.pi / 4 / grid)
        return np.array([*[0.0] * 10, spread * spread])
    return np.array([*ahead.frames.ravel(), ahead.scale_x, (SPREAD / ahead.scale_x) ** 2])


def screen(camera: np.ndarray, width: int, height: int) -> Grid:
    """The tiles of a picture; they see a pixel more on all sides."""
    _, right, up, forward = camera.reshape(4, 3)
    wide, high = float(np.linalg.norm(right)), float(np.linalg.norm(up))
    x, y = width / (2 * TILE), height / (2 * TILE)
    frames = np.stack([right / wide, -up / high, forward])[None]
    across, down = tile_count(width), tile_count(height)
    return Grid(frames, across, down, x / wide, x, y / high, y, 1 / TILE, across * down, -1)


@cache
def cube(grid: int) -> Grid:
    """The cells around a lamp."""
    half = grid / 2
    return Grid(FACES, grid, grid, half, half, half, half, EDGE, 6 * grid * grid, -1)


def seen_by_eye(kernel: Any, tables: ShapeArrays, camera: np.ndarray, width: int, height: int) -> Lists:
    """The shapes in each tile of a picture. `kernel` is `minirt.kernel.culling.binning` or its compiled form."""
    return lists(kernel, tables, camera[:3], screen(camera, width, height), np.zeros(len(tables.planes), bool))


def seen_by_lamp(
    kernel: Any, tables: ShapeArrays, found: Cluster | None, lamp: np.ndarray, grid: int, skipped: np.ndarray
) -> Lists:
    """The shapes in each cell around a lamp, but for the planes that are `skipped` (p,)."""
    ahead = square_ahead(found, lamp, grid)
    seen = lists(kernel, tables, np.array(lamp), cube(grid) if ahead is None else ahead, skipped)
    if grid == 1:
        return one_cell(tables, seen.cones, skipped)
    return seen._replace(light_buffers=around(grid, ahead))


def seen_by_sun(tables: ShapeArrays, grid: int, skipped: np.ndarray) -> Lists:
    """What parallel light may meet: everything in one cell, or with more cells, where a tree is walked, nothing."""
    views = np.zeros((len(tables.slots), 5))
    views[:, 3] = -2.0
    if grid == 1:
        return one_cell(tables, views, skipped)
    return Lists(np.zeros((len(tables.rows), 6 * grid * grid + 1), np.int64), np.zeros(0, np.int32), views)


def lists(kernel: Any, tables: ShapeArrays, origin: np.ndarray, grid: Grid, skipped: np.ndarray) -> Lists:
    """The shapes in each cell of a grid around a point."""
    kinds, stride = len(tables.rows), grid.cells + 1
    views, counts = np.zeros((len(tables.slots), 5)), np.zeros(kinds * stride, np.int64)
    height = heights(tables.planes, origin)
    flat = np.zeros((0, 4), np.int64)
    if not skipped.all():
        shown = ~skipped
        which, cell, columns = runs(grid, -np.sign(height[shown, None]) * tables.planes[shown, :3])
        shape = tables.flat[shown][which]
        cell += tables.slots[shape, 0] * stride
        if grid.elsewhere >= 0:
            shape = np.concatenate([shape, tables.flat[shown]])
            cell = np.concatenate([cell, tables.slots[tables.flat[shown], 0] * stride + grid.elsewhere])
            columns = np.concatenate([columns, np.ones(shown.sum(), np.int64)])
        flat = np.stack([shape, cell, columns, np.ones_like(cell)], axis=1)
        begins, ends = (np.bincount(each, minlength=len(counts)) for each in (cell, cell + columns))
        counts = np.cumsum(begins - ends)
    rectangles = np.empty((len(flat) + len(views) * max(len(grid.frames), 2), 4), np.int32)
    rectangles[: len(flat)] = flat
    slack = MARGIN * float(np.abs(origin).max())
    room = rectangles, len(flat), views, counts
    used = kernel.project_all(origin, grid, tables.balls, slack, tables.first, tables.slots, *room)
    views[tables.flat, 3] = -2.0
    views[tables.flat, 4] = np.abs(height)
    views[:, 4], depths = by_depth(views[:, 4].copy())
    order = in_order(depths[rectangles[:used, 0]])
    starts = np.cumsum(counts)  # for now the ends
    members = np.empty(starts[-1] if kinds else 0, np.int32)
    kernel.fill_bins(rectangles, order, grid.across, starts, members)
    return Lists(starts.reshape(kinds, stride), members, views)


def by_depth(near: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distances rounded down by a step at least, since what is hit so little farther on may be in the same place, and
    their places in the order of depth."""
    depths = np.maximum((near.view(np.int64) >> DROPPED) - NEAREST - 1, 0)
    rounded = np.where(depths > 0, (depths + NEAREST) << DROPPED, 0).view(np.float64)
    return rounded, depths


def in_order(depths: np.ndarray) -> np.ndarray:
    """The indices of places in the order of depth, 21 bits each, from the least on: numpy sorts 16 bits by counting."""
    low = np.argsort(depths.astype(np.uint16), kind="stable")
    order: np.ndarray = low[np.argsort((depths >> 16).astype(np.uint8)[low], kind="stable")]
    return order


def one_cell(tables: ShapeArrays, views: np.ndarray, skipped: np.ndarray) -> Lists:
    """All shapes in a single cell."""
    shapes = np.delete(np.arange(len(views)), tables.flat[skipped])
    kinds = tables.slots[shapes, 0]
    order = np.lexsort((views[shapes, 4], kinds))
    starts = np.searchsorted(kinds[order], np.arange(len(tables.rows))[:, None] + [0, 1])
    return Lists(starts, shapes[order].astype(np.int32), views)
