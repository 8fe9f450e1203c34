"""Rectangles of cells that shapes cover in a grid of directions from a point, by projected bounds.

`project_shapes` projects chunks of shapes, on any number of threads; `minirt.kernel.binning` makes lists of their
rectangles.
"""

from __future__ import annotations

from math import inf
from typing import Any, NamedTuple

from minirt.kernel.pixels import fetch_add
from minirt.kernel.projection import (
    ALL_DIRECTIONS,
    MARGIN,
    Grid,
    bounding_cone,
    cells_of_plane,
    projected_rectangle,
    signed_height,
    store_cone,
)
from minirt.kernel.scene_arrays import KIND, LEAST_DISTANCE, has_rows, vector
from minirt.lanes import Vec

CHUNK = 1024  # shapes that a thread projects at once, at most

# Positive floating-point numbers sort like their bits, the exponent first. Distances sort by their upper 25 bits, from
# 2^-128 on: a relative precision of 2^-13, which is more than `minirt.kernel.trace.COINCIDENT`.
DROPPED_BITS = 39
LEAST_DEPTH = (1023 - 128) << (52 - DROPPED_BITS)


class BinningArrays(NamedTuple):
    """The shapes to project, as in `minirt.rendering.packing.shape_arrays`, and what a point sees of them.

    The rectangles hold for rays from all points within `radius` of the origin, in the directions of their cells; for
    planes also in directions, not normalised, up to `lean` away. A chunk of shapes has its own rows of `rectangles`, as
    many as it has shapes times the frames of the grid; the planes have those behind the last chunk.
    """

    origin: Any  # (3,) the point
    grid: Grid
    radius: float
    reach: float  # from the point, beyond which shapes are in no list
    lean: float
    balls: Any  # (b, 4) centre and radius
    first_ball: Any  # (s + 1,)
    boxes: Any  # (s, 2, 3)
    listed: Any  # (s, 4)
    first_primitive: Any  # (s + 1,) of each shape in the order of the scene
    planes: Any  # (p, 5)
    plane_places: Any  # (p,) their numbers in lists
    shown: Any  # (p,) whether a plane has rectangles
    chunk: int  # shapes in it, at most
    rectangles: Any  # (r, 4) shape, first cell, columns and rows
    used: Any  # (chunks + 1,) rows of each chunk, and of the planes
    cones: Any  # (s, 5) as in `minirt.kernel.scene_arrays`; 0 for shapes without a rectangle
    cone_bits: Any  # (s, 5) the same memory as integers
    sides: Any  # (p,) of each plane, on which the point lies: 1, -1, or 0 where rounding may decide
    found: Any  # (2,) the number of members of all lists, and of planes whose side was another one before
    extents: Any  # float32 (n, 4) or (0, 4): the last column receives bounds of coordinates from the point


def project_shapes(next_chunk: Any, seen: BinningArrays) -> None:
    """Project chunks of shapes, and planes, taking the next ones from the counter `next_chunk` until none is left.

    Any number of threads may do so at the same time.
    """
    while True:
        number = fetch_add(next_chunk, 1)
        if number >= seen.used.shape[0]:
            return
        project_chunk(seen, number)


def project_chunk(seen: BinningArrays, number: int) -> None:
    """Project the shapes of a chunk or, behind the last one, all planes."""
    origin, start = seen.origin, number * seen.chunk * seen.grid.frames.shape[0]
    slack, end = MARGIN * max(abs(origin[0]), abs(origin[1]), abs(origin[2])) + seen.radius, start
    if number + 1 == seen.used.shape[0]:
        end = project_planes(seen, slack, end)
    else:
        first = number * seen.chunk
        for shape in range(first, min(first + seen.chunk, seen.listed.shape[0])):
            end = project_shape(seen, slack, shape, end)
            write_extent(seen, shape)
    seen.used[number] = end - start


def write_extent(seen: BinningArrays, index: int) -> None:
    """Write the extent of the shape with this index in the scene: boxes and extents lie in the order of the scene."""
    if has_rows(seen.extents):
        seen.extents[seen.first_primitive[index], 3] = extent_from(seen.origin, seen.boxes, index)


def project_shape(seen: BinningArrays, slack: float, shape: int, at: int) -> int:
    """Write the rectangles of a shape into `seen.rectangles`, from row `at` on, and its bounding cone into
    `seen.cones`; return the row behind its last rectangle.

    `shape` counts in the order of lists. The shape lies in the convex hull of its spheres, which are
    `balls[first_ball[shape]:first_ball[shape + 1]]`, grown by `slack`. For a plane, which has none, nothing is written.
    A shape out of `reach` has no rectangle, and the cone of a shape without one is 0.
    """
    grid, start, end, before = seen.grid, seen.first_ball[shape], seen.first_ball[shape + 1], at
    if start == end:
        return at
    if seen.reach < inf:  # for the distance of the shape
        bounding_cone(seen.origin, seen.balls, start, end, slack, seen.cones[shape])
    is_near = seen.cones[shape, LEAST_DISTANCE] <= seen.reach
    for face in range(grid.frames.shape[0] if is_near else 0):
        column, row, columns, rows = projected_rectangle(seen.origin, grid, face, seen.balls, start, end, slack)
        if columns > 0 and rows > 0:
            at = write_rectangle(seen, at, shape, face * grid.down + row, column, columns, rows)
    for column_of_cone in range(5):
        seen.cones[shape, column_of_cone] = 0.0
    if at > before:
        bounding_cone(seen.origin, seen.balls, start, end, slack, seen.cones[shape])
    quantise_distance(seen, shape)
    return at


def write_rectangle(seen: BinningArrays, at: int, shape: int, row: int, column: int, columns: int, rows: int) -> int:
    """Write rectangle number `at`, and return the next number. The cells of each kind are followed by one more."""
    seen.rectangles[at, 0] = shape
    seen.rectangles[at, 1] = seen.listed[shape, KIND] * (seen.grid.cells + 1) + row * seen.grid.across + column
    seen.rectangles[at, 2] = columns
    seen.rectangles[at, 3] = rows
    return at + 1


def extent_from(origin: Any, boxes: Any, shape: int) -> float:
    """Return an upper bound of the largest coordinate of a shape relative to a point."""
    farthest, size = 0.0, 0.0
    for axis in range(3):
        low, high = boxes[shape, 0, axis], boxes[shape, 1, axis]
        farthest, size = max(farthest, abs((low + high) / 2 - origin[axis])), max(size, high - low)
    return farthest + size / 2


def quantise_distance(seen: BinningArrays, shape: int) -> None:
    """Round the distance of a cone down to its upper bits, by at least one step: a hit that is so little farther may
    count as coincident."""
    depth = (seen.cone_bits[shape, LEAST_DISTANCE] >> DROPPED_BITS) - 1
    seen.cone_bits[shape, LEAST_DISTANCE] = depth << DROPPED_BITS if depth > LEAST_DEPTH else 0


def project_planes(seen: BinningArrays, slack: float, at: int) -> int:
    """Project all planes to rectangles of one row of cells, from row `at` of `seen.rectangles` on.

    Returns the row behind the last rectangle. The cones and sides of the planes are written, too, and `seen.found[1]`
    is increased by the number of planes whose side has changed.
    """
    for number in range(seen.planes.shape[0]):
        plane, shape = seen.planes[number], seen.plane_places[number]
        height = signed_height(plane, vector(seen.origin, 0), slack)
        side = 0
        if height > 0.0:
            side = 1
        elif height < 0.0:
            side = -1
        if seen.sides[number] != side:
            seen.found[1] += 1
        seen.sides[number] = side
        store_cone(seen.cones[shape], Vec(0.0, 0.0, 0.0), ALL_DIRECTIONS, abs(height))
        quantise_distance(seen, shape)
        if seen.shown[number] and abs(height) <= seen.reach:
            for row in range(seen.grid.frames.shape[0] * seen.grid.down):
                away = -side * vector(plane, 0)  # 0, 0, 0 where the point may lie on it: all cells are covered
                column, columns = cells_of_plane(seen.grid, row, away, seen.lean)
                if columns > 0:
                    at = write_rectangle(seen, at, shape, row, column, columns, 1)
    return at


def rectangle_at(seen: BinningArrays, at: int) -> tuple[int, int, int, int]:
    """Return shape, first cell, columns and rows of a rectangle."""
    rectangle = seen.rectangles[at]
    return int(rectangle[0]), int(rectangle[1]), int(rectangle[2]), int(rectangle[3])
