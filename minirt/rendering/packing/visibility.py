"""Visibility culling: bins the shapes that the eye sees into screen tiles, and the shapes that a light sees into the
cells of its light buffer (Haines and Greenberg, The light buffer: a shadow-testing accelerator, 1986).
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from minirt.helpers import system
from minirt.kernel.binning import MARGIN, Grid
from minirt.kernel.frame import tile_count
from minirt.kernel.pixels import TILE
from minirt.rendering.packing.camera import Crop
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.shapes.mesh import Mesh

# Vectors across, down and forward of the six faces of a cube, in the order of `cell_of_cube` in
# `minirt.kernel.shadow_rays`.
FACES = np.array([np.roll(np.diag([1.0, 1.0, side]), axis + 1, axis=1) for axis in range(3) for side in (1, -1)])
SPREAD = 0.5  # of the mean angle of a cell: the list of a cell holds for all directions so close to one in it
# Cells by which the intervals of a cube grow so that a list holds for directions up to `SPREAD` away: at the corner of
# a face, where slopes change most with the angle, an angle e changes them by less than 3 e.
CUBE_MARGIN = 3 * SPREAD * np.pi / 4
# The most shapes, and the cells along an edge of a light's cube with which building and using the lists was measured to
# take least. Of the triangles of a mesh, which lie side by side, the first `FEW` count, and one in `SIDE_BY_SIDE` more.
SMALL = 8
FEW, SIDE_BY_SIDE = 200, 8
CELLS_BY_SHAPES = ((SMALL, 1), (30, 16), (200, 32), (1_000, 64), (50_000, 128), (500_000, 256), (np.inf, 512))

MEMBER, START = 4, 8  # bytes of a member and of a start of a list
COARSEST = 16  # cells along an edge of a light buffer that memory limits
QUICKLY_BUILT = 2**29  # bytes of lists that are built within seconds
MOST_MEMBERS = 2**24  # of all cells that have every shape
RUN = 120  # bytes of a plane in a row of cells, while its runs are computed

# Positive floating-point numbers sort like their bits, the exponent first. Depths sort by their upper 25 bits, from
# 2^-128 on: a relative precision of 2^-13, which is more than `minirt.kernel.trace.COINCIDENT`.
DROPPED_BITS = 39
LEAST_DEPTH = (1023 - 128) << (52 - DROPPED_BITS)


class BinnedShapes(NamedTuple):
    """The shapes that may be hit in each cell: `members[starts[kind, cell]:starts[kind, cell + 1]]`, nearest first."""

    starts: np.ndarray  # (kinds, cells + 1)
    members: np.ndarray
    cones: np.ndarray  # (n, 5) as in `minirt.kernel.scene_arrays`
    tolerance: float = 0.0  # of the lists of a light: see `minirt.kernel.shadow_rays`


def light_buffer_cells(shape_arrays: ShapeArrays) -> int:
    """Choose the cells along an edge of the cube around a light; 1 where trying all shapes is faster than a lookup."""
    shapes = 0
    for kind, rows in zip(shape_arrays.group_numbers, shape_arrays.rows, strict=True):
        shapes += min(len(rows), FEW + len(rows) // SIDE_BY_SIDE) if kind is Mesh else len(rows)
    return next(cells for most, cells in CELLS_BY_SHAPES if shapes <= most)


def screen_grid(camera: np.ndarray, width: int, height: int, crop: Crop) -> Grid:
    """The tiles of a rectangle of so many pixels of a picture as a grid, each extended by a pixel on all sides."""
    _, right, up, forward = camera.reshape(4, 3)
    half_width, half_height = float(np.linalg.norm(right)), float(np.linalg.norm(up))
    x, y = crop.width / (2 * TILE), crop.height / (2 * TILE)
    frames = np.stack([right / half_width, -up / half_height, forward])[None]
    across, down = tile_count(width), tile_count(height)
    first = crop.left // TILE, crop.top // TILE
    return Grid(frames, across, down, x / half_width, x, y / half_height, y, 1 / TILE, across * down, *first)


@cache
def cube_grid(cells: int) -> Grid:
    """The six faces of the cube around a light as a grid, so many cells along an edge."""
    half = cells / 2
    return Grid(FACES, cells, cells, half, half, half, half, CUBE_MARGIN, 6 * cells * cells)


def seen_by_eye(
    kernel: Any,
    shape_arrays: ShapeArrays,
    camera: np.ndarray,
    width: int,
    height: int,
    crop: Crop,
    radius: float = 0.0,
    per_focus: float = 0.0,
) -> BinnedShapes:
    """Bin the shapes into the tiles of a rectangle of a picture. `kernel` is `minirt.kernel.binning` or its
    compiled form.

    A ray of a lens of some radius differs, at depth z, from that through its centre by the radius times
    1 - z `per_focus` at most.
    """
    none = np.zeros(len(shape_arrays.planes), bool)
    balls = shape_arrays.balls
    if radius:
        depth = (balls[:, :3] - camera[:3]) @ camera[9:12]
        ends = np.maximum(depth + np.array([[-1.0], [1.0]]) * balls[:, 3], 0.0)
        balls = balls.copy()
        balls[:, 3] += radius * np.maximum(np.abs(1.0 - per_focus * ends).max(axis=0) - 1.0, 0.0)
    grid = screen_grid(camera, width, height, crop)
    return bin_shapes(kernel, shape_arrays, balls, camera[:3], grid, none, radius, radius * per_focus)


def seen_by_light(
    kernel: Any,
    shape_arrays: ShapeArrays,
    light: np.ndarray,
    cells: int,
    skipped: np.ndarray,
    radius: float = 0.0,
    copies: int = 1,
) -> BinnedShapes:
    """Bin the shapes into the light buffer of a light of some radius, without the planes that are `skipped` (p,).

    `TooLargeError` where there is no room for so many copies of its lists.
    """
    largest = QUICKLY_BUILT if cells > COARSEST else system.UNLIMITED
    place = np.array(light), cube_grid(cells)
    binned = bin_shapes(kernel, shape_arrays, shape_arrays.balls, *place, skipped, radius, 0.0, copies, largest)
    if cells == 1:
        return in_all_cells(shape_arrays, 1, skipped, binned.cones)
    spread = 2 * np.sin(SPREAD * np.pi / 4 / cells)  # distance up to which lists hold around a cell
    return binned._replace(tolerance=float(spread * spread))


def seen_by_parallel_light(shape_arrays: ShapeArrays, cells: int, skipped: np.ndarray) -> BinnedShapes:
    """Put all shapes into one cell; where there are more cells, none at all, because the kernel traverses a BVH."""
    every = in_all_cells(shape_arrays, 1, skipped)
    if cells == 1:
        return every
    starts = np.zeros((len(shape_arrays.rows), 6 * cells * cells + 1), np.int64)
    return every._replace(starts=starts, members=every.members[:0])


def bin_shapes(
    kernel: Any,
    shape_arrays: ShapeArrays,
    balls: np.ndarray,
    origin: np.ndarray,
    grid: Grid,
    skipped: np.ndarray,
    radius: float = 0.0,
    lean: float = 0.0,
    copies: int = 1,
    largest: int = system.UNLIMITED,
) -> BinnedShapes:
    """Bin the shapes, which `balls` enclose, into the cells of a grid of directions from a point.

    The lists hold for rays from all points within `radius`, in the directions of a cell. They hold for planes in
    directions, not normalised, up to `lean` away, too. `TooLargeError` where there is no room for so many copies of
    the lists, or where they would have more than `largest` bytes.
    """
    height = signed_heights(shape_arrays.planes, origin, radius)
    shown = ~skipped
    planes, heights = shape_arrays.planes[shown], height[shown]
    towards = -np.sign(heights[:, None]) * planes[:, :3]
    kinds, stride = len(shape_arrays.rows), grid.cells + 1
    fixed = copies * kinds * stride * START + len(planes) * len(grid.frames) * grid.down * RUN
    check_lists(fixed, largest)
    cones, counts = np.zeros((len(shape_arrays.slots), 5)), np.zeros(kinds * stride, np.int64)
    plane_rectangles = np.zeros((0, 4), np.int64)
    if len(planes):
        plane, cell, columns = cell_runs(grid, towards, lean)
        shape = shape_arrays.plane_indices[shown][plane]
        cell += shape_arrays.slots[shape, 0] * stride
        plane_rectangles = np.stack([shape, cell, columns, np.ones_like(cell)], axis=1)
        begins, ends = (np.bincount(each, minlength=len(counts)) for each in (cell, cell + columns))
        counts = np.cumsum(begins - ends)
    rectangles = np.empty((len(plane_rectangles) + len(cones) * len(grid.frames), 4), np.int32)
    rectangles[: len(plane_rectangles)] = plane_rectangles
    slack = MARGIN * float(np.abs(origin).max()) + radius
    output = rectangles, len(plane_rectangles), cones, counts
    used = kernel.project_all(origin, grid, balls, slack, shape_arrays.first_ball, shape_arrays.slots, *output)
    starts = np.cumsum(counts)  # the ends, until `fill_bins` has counted them down
    count = int(starts[-1]) if kinds else 0
    check_lists(fixed + copies * count * MEMBER, largest)
    cones[shape_arrays.plane_indices, 3] = -2.0
    cones[shape_arrays.plane_indices, 4] = np.abs(height)
    cones[:, 4], depths = quantised_depths(cones[:, 4].copy())
    order = depth_order(depths[rectangles[:used, 0]])
    members = np.empty(count, np.int32)
    kernel.fill_bins(rectangles, order, grid.across, starts, members)
    return BinnedShapes(starts.reshape(kinds, stride), members, cones)


def check_lists(size: int, largest: int) -> None:
    """Raise `TooLargeError` where lists of this size, in bytes, have no room or are larger than they may."""
    advice = "fewer or smaller shapes, or fewer lights, need less"
    system.check_memory(size, "the lists of shapes in view need", advice, largest)


def quantised_depths(distances: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Round distances down by at least one step, and return them and their integer sort keys.

    By at least one, because a hit that is so little farther may count as coincident.
    """
    depths = np.maximum((distances.view(np.int64) >> DROPPED_BITS) - LEAST_DEPTH - 1, 0)
    rounded = np.where(depths > 0, (depths + LEAST_DEPTH) << DROPPED_BITS, 0).view(np.float64)
    return rounded, depths


def depth_order(depths: np.ndarray) -> np.ndarray:
    """Argsort integer depths of 21 bits, least first, in two passes: numpy sorts up to 16 bits by counting."""
    low = np.argsort(depths.astype(np.uint16), kind="stable")
    order: np.ndarray = low[np.argsort((depths >> 16).astype(np.uint8)[low], kind="stable")]
    return order


def in_all_cells(
    shape_arrays: ShapeArrays, cells: int, skipped: np.ndarray | None = None, cones: np.ndarray | None = None
) -> BinnedShapes:
    """Put all shapes, but for the planes that are `skipped`, into each cell; `cones` that are not given hold all
    directions.

    `TooLargeError` where many cells have so many shapes that nobody would wait for the picture.
    """
    count = len(shape_arrays.slots)
    if cells > 1 and cells * count > MOST_MEMBERS:
        raise system.TooLargeError(f"{count} shapes in each of {cells} tiles are too many")
    if cones is None:
        cones = np.tile([0.0, 0.0, 0.0, -2.0, 0.0], (count, 1))
    shapes = np.delete(np.arange(count), [] if skipped is None else shape_arrays.plane_indices[skipped])
    kinds = shape_arrays.slots[shapes, 0]
    order = np.lexsort((cones[shapes, 4], kinds))
    members = shapes[order].astype(np.int32)
    ends = np.searchsorted(kinds[order], np.arange(len(shape_arrays.rows))[:, None] + [0, 1])
    # All lists of one kind come first, then all lists of the next kind.
    lists = [np.tile(members[first:last], cells) for first, last in ends]
    starts = cells * ends[:, :1] + np.diff(ends) * np.arange(cells + 1)
    return BinnedShapes(starts, np.concatenate([members[:0], *lists]), cones)


# Infinite planes.


def signed_heights(planes: np.ndarray, point: np.ndarray, radius: float = 0.0) -> np.ndarray:
    """Lower bounds of the heights of a ball about a point above planes, (p, 5) as in
    `minirt.rendering.packing.shape_arrays`.

    They are negative below a plane, and 0 where the ball meets it or rounding may decide.
    """
    above = planes[:, :3] @ point - planes[:, 3]
    slack = planes[:, 4] + MARGIN * np.abs(point).max() + radius  # rounding errors, upper bounds of them
    bounds: np.ndarray = np.sign(above) * np.maximum(np.abs(above) - slack, 0.0)
    return bounds


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
