"""Visibility culling: bins the shapes that a point sees into the cells of a grid, such as the tiles of the screen.

`minirt.rendering.packing.light_buffers` does so for lights.
"""

from __future__ import annotations

from collections.abc import Callable
from struct import pack_into
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from minirt.helpers import system
from minirt.kernel.binning import RADIX
from minirt.kernel.frame import tile_count
from minirt.kernel.machine_code.library import bound
from minirt.kernel.moving_camera import Followers
from minirt.kernel.pixels import TILE
from minirt.kernel.projection import Grid
from minirt.kernel.rectangles import CHUNK, BinningArrays
from minirt.kernel.scene_arrays import KIND, LEAST_DISTANCE
from minirt.rendering.packing.camera import Place
from minirt.rendering.packing.shape_arrays import ShapeArrays

# The most shapes, and pixels along an edge of the squares of the screen with which drawing was measured to take least.
SQUARES_BY_SHAPES = ((50_000, TILE), (500_000, TILE // 2), (np.inf, TILE // 4))

RECTANGLE = 32  # bytes of a rectangle of cells, and of its places in a sorted list
MOST_MEMBERS = 2**24  # of all cells that have every shape
LITTLE = 1 / 64  # of lists to spare, in which shapes may move
MEMBERS, CROSSED = 0, 1  # of what is `found`: members of all lists, and planes whose side changed
PARALLEL = 4096  # shapes from which on several threads project them

NO_EXTENTS = np.zeros((0, 4), np.float32)
NO_TABLES = np.zeros((0, 5), np.int64), np.zeros(0, np.int64), np.zeros(5)
STILL = Followers(np.zeros(14), np.zeros((2, 0)), np.zeros(0), *NO_TABLES)  # arrays of which none follows
# Fields of `BinningArrays`, and of `ShapeArrays`.
BOUNDS = "balls", "first_ball", "boxes", "listed", "first_primitive", "planes", "plane_places"
Run: TypeAlias = Callable[[Callable[[], Any]], object]  # runs a job on all threads


class BinnedShapes(NamedTuple):
    """The shapes that may be hit in each cell: `members[starts[kind, cell]:starts[kind, cell + 1]]`, nearest first."""

    starts: np.ndarray  # int32 (kinds, cells + 1)
    members: np.ndarray
    cones: np.ndarray  # (n, 5) as in `minirt.kernel.scene_arrays`
    bins: Bins | None = None  # which binned them, if any


def screen_grid(half_width: float, half_height: float, place: Place, square: int = TILE) -> Grid:
    """The tiles, or smaller squares, of a rectangle of a picture as a grid, each extended by a pixel on all sides.

    `half_width` and `half_height` are the slopes at the edges of the picture. The frame is that of a camera to come.
    """
    *size, crop = place
    across, down = (tile_count(pixels, square) for pixels in size)
    x, y = crop.width / (2 * square), crop.height / (2 * square)
    first = crop.left // square, crop.top // square
    scales = x / half_width, x, y / half_height, y
    return Grid(np.zeros((1, 3, 3)), across, down, *scales, 1 / square, across * down, *first)


def square_edge(shape_arrays: ShapeArrays, packet_width: int) -> int:
    """Choose the pixels along an edge of the squares of the screen that have lists: a tile or, in a crowd, a part of
    it that is not smaller than a packet."""
    count = len(shape_arrays.listed)
    return max(packet_width, next(edge for most, edge in SQUARES_BY_SHAPES if count <= most))


class Bins:
    """The shapes in the cells of a grid of directions from a point: when it moves they are binned anew, in the same
    arrays.

    All shapes within `reach` are seen from any point within `radius` of it, both in scene units; `lean` is how far the
    directions, not normalised, may be off those of a cell. `extents`, (n, 4) float32, receive bounds of the shapes'
    coordinates, or have no rows. There is to be room for `copies` of the lists, all of at most `largest` bytes.
    """

    copies, largest = 1, system.UNLIMITED
    last: tuple[Any, ...] = ()  # the pose and the planes that the lists are for
    skipped = b""  # planes that are left out: the bytes of an array of bool
    followers = STILL  # arrays that follow the pose
    pack: Callable[[], Any] | None = None  # the call that makes the lists and lets the arrays follow
    updates = 0  # of the shapes, up to which the lists are theirs

    def __init__(
        self,
        kernel: Any,
        shape_arrays: ShapeArrays,
        grid: Grid,
        radius: float = 0.0,
        lean: float = 0.0,
        extents: np.ndarray = NO_EXTENTS,
        reach: float = np.inf,
    ) -> None:
        shapes, planes, kinds = len(shape_arrays.listed), len(shape_arrays.planes), len(shape_arrays.tables)
        chunk = max(1, min(CHUNK, shapes))
        chunks, rows_of_planes = -(-shapes // chunk), planes * len(grid.frames) * grid.down
        self.kernel, self.shapes = kernel, shape_arrays
        self.is_large, self.bytes_of_planes = shapes >= PARALLEL, rows_of_planes * RECTANGLE
        # Rectangles: of each shape one for each frame, of each plane one for each row of cells.
        room, cones = chunks * chunk * len(grid.frames) + rows_of_planes, np.zeros((shapes, 5))
        self.pose = np.append(np.zeros(3), grid.frames)
        self.arrays = BinningArrays(
            origin=self.pose[:3],
            grid=grid._replace(frames=self.pose[3:].reshape(-1, 3, 3)),
            radius=radius,
            reach=reach,
            lean=lean,
            **{name: getattr(shape_arrays, name) for name in BOUNDS},
            shown=np.ones(planes, np.int64),
            chunk=chunk,
            rectangles=np.empty((room, 4), np.int32),
            used=np.zeros(chunks + 1, np.int64),
            cones=cones,
            cone_bits=cones.view(np.int64),  # the same memory, as integers
            sides=np.zeros(planes, np.int64),  # of each plane, on which the point lies
            found=np.zeros(2, np.int64),
            extents=extents,
        )
        self.counter, self.entries = np.zeros(1, np.int64), np.empty((2, room), np.int64)
        self.starts, self.members = np.zeros((kinds, grid.cells + 1), np.int32), np.zeros(0, np.int32)
        if self.is_large:
            self.project = bound(kernel.project_shapes, self.counter, self.arrays)

    def fit(self, shape_arrays: ShapeArrays, grid: Grid, radius: float, reach: float = np.inf) -> bool:
        """Whether these bins can be used for shapes in the same arrays, as seen in such a grid."""
        mine = self.arrays
        is_alike = (mine.grid[1:], mine.radius, mine.reach) == (grid[1:], radius, reach)
        return mine.balls is shape_arrays.balls and is_alike

    def packing(self) -> Callable[[], Any]:
        """Return the call that bins the shapes and lets the followers follow."""
        lists = self.arrays, self.starts.reshape(-1), self.members, self.entries, np.empty(2**RADIX, np.int64)
        return bound(self.kernel.pack_frame, self.followers, self.counter, *lists)

    def see_from(self, pose: tuple[float, ...], run: Run | None = None, spare: float = LITTLE) -> None:
        """Bin the shapes as seen from a `pose`, many of them on all threads by `run`; `starts` and `members` are
        written.

        The pose has the 3 numbers of the point, then the 9 of the frame where the grid is that of a camera. Where
        nothing is moved but one shape, its entries alone change. New lists leave room for a `spare` share of members.
        `TooLargeError` where there is no room.
        """
        if not len(self.members):
            self.check(0)
        view: Any = *pose, self.skipped
        moved: Any = np.flatnonzero(self.shapes.written > self.updates) if self.shapes.updates > self.updates else []
        first_moved = moved[:2]  # of more than one all are binned anew
        same = view == self.last and not self.shapes.is_plane[self.shapes.listed[first_moved, KIND]].any()
        self.updates, self.last = self.shapes.updates, ()  # after an error the lists are those of no view
        self.counter[0], self.arrays.found[CROSSED] = 0, 0
        pack_into(f"{len(pose)}d", self.pose.data, 0, *pose)
        if same and len(moved) == 1:
            self.kernel.move_shape(int(moved[0]), self.arrays, self.starts.reshape(-1), self.members)
        elif not same or len(moved):
            if run and self.is_large:
                run(self.project)
            self.pack = self.pack or self.packing()
            self.pack()
        count = int(self.arrays.found[MEMBERS])
        if count > len(self.members):
            self.check(count)
            self.members = np.zeros(int(count * (1.0 + spare)), np.int32)
            self.pack, self.counter[0] = self.packing(), len(self.arrays.used)  # all are projected
            self.pack()
        self.last = view

    def check(self, members: int) -> None:
        size = self.copies * (self.starts.nbytes + members * self.members.itemsize) + self.bytes_of_planes
        advice = "fewer or smaller shapes, or fewer lights, need less"
        system.check_memory(size, "the lists of shapes in view need", advice, self.largest)


def in_all_cells(
    shape_arrays: ShapeArrays, cells: int, skipped: np.ndarray | None = None, cones: np.ndarray | None = None
) -> BinnedShapes:
    """Put all shapes, but for the planes that are `skipped` (p,), into each cell, the nearest of each kind first.

    `cones` (s, 5) are the bounding cones of the shapes; without them all cones hold all directions. `TooLargeError`
    where many cells have so many shapes that nobody would wait for the picture.
    """
    count = len(shape_arrays.listed)
    if cells > 1 and cells * count > MOST_MEMBERS:
        raise system.TooLargeError(f"{count} shapes in each of {cells} tiles are too many")
    if cones is None:
        cones = np.tile([0.0, 0.0, 0.0, -2.0, 0.0], (count, 1))  # any cosine is more than -2
    shapes = np.setdiff1d(np.arange(count), [] if skipped is None else shape_arrays.plane_places[skipped])
    kinds = shape_arrays.listed[shapes, KIND]
    order = np.lexsort((cones[shapes, LEAST_DISTANCE], kinds))
    members = shapes[order].astype(np.int32)
    ends = np.searchsorted(kinds[order], np.arange(len(shape_arrays.tables))[:, None] + [0, 1])
    # All lists of one kind come first, then all lists of the next kind.
    lists = [np.tile(members[first:last], cells) for first, last in ends]
    starts = cells * ends[:, :1] + np.diff(ends) * np.arange(cells + 1)
    return BinnedShapes(starts.astype(np.int32), np.concatenate([members[:0], *lists]), cones)
