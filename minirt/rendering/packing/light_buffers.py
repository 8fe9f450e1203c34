"""Light buffers (Haines and Greenberg, The light buffer: a shadow-testing accelerator, 1986): bins the shapes that a
light sees into the cells of a cube around it.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from minirt.helpers import system
from minirt.kernel.projection import Grid
from minirt.kernel.shadow_rays import CIRCLE
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.packing.visibility import BinnedShapes, Bins, Run, in_all_cells

# Vectors across, down and forward of the six faces of a cube, in the order of `light_buffer_cell` in
# `minirt.kernel.shadow_rays`.
FACES = np.array([np.roll(np.diag([1.0, 1.0, side]), axis + 1, axis=1) for axis in range(3) for side in (1, -1)])
# The most shapes, and the cells along an edge of a light's cube with which building and using the lists was measured to
# take least. A mesh, which has a tree of its own, is one shape.
SMALL = 8
CELLS_BY_SHAPES = ((SMALL, 1), (30, 16), (200, 32), (1_000, 64), (50_000, 128), (500_000, 256), (np.inf, 512))
COARSEST = 16  # cells along an edge of a light buffer that memory limits
QUICKLY_BUILT = 2**28  # bytes of lists that are built within seconds
MOST_CONES = QUICKLY_BUILT // 80  # of all lights: 40 bytes each, and a copy
NO_CONES = np.zeros((0, 5))


def has_cones(lights: int, shapes: int) -> bool:
    """Whether the bounding cones as seen from lights are made; else all are zeros, whose memory the system does not
    allocate, and which hold all directions: cosines of angles from no axis are 0."""
    return lights == 1 or lights * shapes <= MOST_CONES


def light_buffer_cells(shape_arrays: ShapeArrays) -> int:
    """Choose the cells along an edge of the cube around a light; 1 where trying all shapes is faster than a lookup."""
    return next(cells for most, cells in CELLS_BY_SHAPES if len(shape_arrays.listed) <= most)


@cache
def cube_grid(cells: int) -> Grid:
    """The six faces of the cube around a light as a grid, so many cells along an edge.

    Intervals grow by the radius of the circle around a cell. On the way from its middle to its rim |v| sqrt(1 + x^2),
    see `minirt.kernel.projection.margin_around`, grows by less than 5 / cells; 0.01 cells are for rounding to float32.
    """
    half, margin = cells / 2, CIRCLE / 2 * (1 + 5 / cells) + 0.01
    return Grid(FACES, cells, cells, half, half, half, half, margin, 6 * cells * cells)


def seen_by_light(
    kernel: Any,
    shape_arrays: ShapeArrays,
    position: np.ndarray,
    cells: int,
    skipped: np.ndarray,
    radius: float = 0.0,
    reach: float = np.inf,
    copies: int = 1,
    run: Run | None = None,
    spare: Bins | None = None,
) -> BinnedShapes:
    """Bin the shapes that a light sees into its light buffer, with `cells` cells along an edge of its cube; with one
    cell list all shapes.

    The light is a ball of some radius about its `position`, (3,). Shapes beyond its `reach`, in scene units, and planes
    for which `skipped` (p,) is True are left out. `kernel` has the functions that bin, compiled or interpreted, and
    `run` runs them on all threads. `spare` bins are overwritten and used again where they fit. `TooLargeError` where
    there is no room for `copies` copies of the lists, or where lists of small cells would take long to build.
    """
    grid = cube_grid(cells)
    fits = spare and spare.fit(shape_arrays, grid, radius, reach)
    bins = spare if spare and fits else Bins(kernel, shape_arrays, grid, radius, reach=reach)
    bins.arrays.shown[:] = np.where(skipped, 0, 1)
    bins.skipped, bins.copies = skipped.tobytes(), copies
    bins.largest = QUICKLY_BUILT if cells > COARSEST else system.UNLIMITED
    bins.see_from(tuple(position.tolist()), run)
    if cells == 1:
        return in_all_cells(shape_arrays, 1, skipped, bins.arrays.cones)
    return BinnedShapes(bins.starts, bins.members[: bins.starts[-1, -1]], bins.arrays.cones, bins)


def seen_by_parallel_light(shape_arrays: ShapeArrays, cells: int, skipped: np.ndarray) -> BinnedShapes:
    """Put all shapes into one cell; where there are more cells, none at all, because the kernel traverses a BVH."""
    every = in_all_cells(shape_arrays, 1, skipped)
    if cells == 1:
        return every
    starts = np.zeros((len(shape_arrays.tables), 6 * cells * cells + 1), np.int32)
    return every._replace(starts=starts, members=every.members[:0])


def joined_light_buffers(binned: list[BinnedShapes], shapes: ShapeArrays) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Join the bins of m lights; return the starts of their lists, (kinds, m, cells + 1), and fields of `SceneArrays`
    by their names."""
    starts, members = np.zeros((len(shapes.tables), 0, 1), np.int32), np.zeros(0, np.int32)
    cones = np.zeros((0, len(shapes.listed), 5))
    if len(binned) == 1:  # in the same memory: a million shapes take long to copy
        starts, cones, members = binned[0].starts[:, None], binned[0].cones[None], binned[0].members
    elif binned:
        offsets = np.cumsum([0, *(len(each.members) for each in binned[:-1])], dtype=np.int32)
        starts = np.stack([each.starts + offset for each, offset in zip(binned, offsets, strict=True)], axis=1)
        cones = np.zeros((len(binned), len(shapes.listed), 5))
        if has_cones(*cones.shape[:2]):
            np.stack([each.cones for each in binned], out=cones)
        members = np.concatenate([each.members for each in binned])
    return starts, {"light_shapes": members, "light_cones": cones}
