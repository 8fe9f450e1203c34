"""Views: the shapes that a camera sees, in arrays that follow it when it moves; and packed scenes in float32.

float32 is less precise, with twice as many rays per SIMD register. Everything is moved so that the eye is the origin
before it is rounded, so that whatever is near the eye is precise. Bounds used for culling are rounded to the safe side.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from typing import Any

import numpy as np

from minirt.kernel.beams import CENTRE
from minirt.kernel.machine_code.library import bound
from minirt.kernel.pixels import PACKET_HEIGHT
from minirt.kernel.scene_arrays import Group, SceneArrays, kind_of, row_axes, row_type
from minirt.kernel.shading.patterns import COLUMNS, ORIGIN
from minirt.lanes import width
from minirt.rendering.packing.camera import (
    Place,
    camera_frame,
    camera_numbers,
    pixel_rays,
    radius_and_focus,
    slopes_at_edges,
)
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.packing.visibility import BinnedShapes, Bins, Run, screen_grid, square_edge
from minirt.scene import Camera

SPARE = 0.25  # of the lists of a camera that moves


class View:
    """The shapes in the tiles of a picture, or of a rectangle of one, and all else that depends on the camera."""

    bins: Bins
    rounding: Rounding | None = None  # of a scene in float32

    def __init__(
        self,
        kernel: Any,
        shapes: ShapeArrays,
        camera: Camera,
        place: Place,
        lens: np.ndarray | None,
        precision: str,
        spare: View | None,
    ) -> None:
        """The bins of a `spare` view are used again where they fit."""
        self.size = place[2][:2]  # of the whole picture
        radius, per_focus = radius_and_focus(lens)
        if radius:
            shapes = copy(shapes)
            shapes.balls = blurred_balls(shapes.balls, camera_numbers(camera, *self.size), radius, per_focus)
        extents = np.zeros((len(shapes.slots) * (precision == "single"), 4), np.float32)
        self.square = square_edge(shapes, width(extents if len(extents) else shapes.balls) // PACKET_HEIGHT)
        grid = screen_grid(*slopes_at_edges(camera, *self.size), place, self.square)
        if spare and spare.bins.fit(shapes, grid, radius) and len(spare.bins.seen.extents) == len(extents):
            self.bins = spare.bins
        else:
            self.bins = Bins(kernel, shapes, grid, radius, radius * per_focus, extents=extents)

    def look(self, camera: Camera, run: Run | None) -> BinnedShapes:
        """Bin the shapes that a camera sees into tiles."""
        right, (x, y, z), forward = camera_frame(camera)
        self.bins.seen.grid.frames[0] = right, (-x, -y, -z), forward
        self.bins.see_from(camera.position, run, SPARE)
        self.seen = self.bins.seen.sides.tobytes(), id(self.bins.members)
        return BinnedShapes(self.bins.starts, self.bins.members, self.bins.seen.cones)

    def follow(self, camera: Camera, arrays: SceneArrays, run: Run | None) -> bool:
        """Let the arrays of a scene follow its camera; False where that takes other arrays, and these are spoilt."""
        before = self.seen
        self.look(camera, run)
        rays = pixel_rays(camera, *self.size)
        if self.rounding:
            self.rounding.move(rays[:3])
            rays[:3] = 0.0
        arrays.camera[:12] = rays
        return self.seen == before


def blurred_balls(balls: np.ndarray, camera: np.ndarray, radius: float, per_focus: float) -> np.ndarray:
    """Grow balls by what a lens of some radius adds, for `camera_numbers`.

    A ray of the lens differs, at depth z, from that through its centre by the radius times 1 - z `per_focus` at most.
    """
    depth = (balls[:, :3] - camera[:3]) @ camera[9:12]
    ends = np.maximum(depth + np.array([[-1.0], [1.0]]) * balls[:, 3], 0.0)
    grown = balls.copy()
    grown[:, 3] += radius * np.maximum(np.abs(1.0 - per_focus * ends).max(axis=0) - 1.0, 0.0)
    return grown


# float32.


MARGIN = 2.0**-21  # of a cosine: a few roundings of a scalar product of unit vectors
POINT, OTHER, COSINE = (0, 1, 2), 3, 4  # the place, in `Rounding.shifts`, of what is subtracted from a column
PLACE = (*(OTHER,) * CENTRE, *POINT, OTHER, OTHER)  # of `MeshTrees.places`
GRID = *POINT, *(OTHER,) * 5  # of `LightGrid.grids`
CONE = OTHER, OTHER, OTHER, COSINE, OTHER  # a distance needs no margin: it was rounded down to 13 bits


class Rounding:
    """Tables rounded to float32 relative to an eye; when it moves they are rounded anew, in the same arrays."""

    def __init__(self, kernel: Any, eye: np.ndarray) -> None:
        self.kernel = kernel
        self.shifts = np.array([*eye, 0.0, MARGIN])
        self.calls: list[Callable[[], Any]] = []

    def move(self, eye: np.ndarray) -> None:
        self.shifts[:3] = eye
        for call in self.calls:
            call()

    def rounded(self, table: np.ndarray, columns: tuple[int, ...]) -> np.ndarray:
        """Return a table of float64, (n, c), rounded now and when the eye moves. `columns` tells what each one holds:
        a part of `POINT`, `COSINE` or `OTHER`."""
        into = np.empty(table.shape, np.float32)
        self.calls.append(bound(self.kernel.to_single, table, np.array(columns), self.shifts, into))
        self.calls[-1]()
        return into

    def rows(self, rows: np.ndarray) -> np.ndarray:
        kind, table = kind_of(rows.dtype.names), rows.view(np.float64).reshape(len(rows), -1)
        return self.rounded(table, row_axes(kind)).view(row_type(kind, np.float32))[:, 0]

    def group(self, group: Group) -> Group:
        """Return a group with its shapes, or with the places of its meshes and of their points."""
        trees, triangles = group.trees, group.triangles
        if not triangles:
            return group._replace(rows=self.rows(group.rows))
        triangles = as_single(triangles._replace(points=self.rounded(triangles.points, POINT)))
        return group._replace(trees=trees._replace(places=self.rounded(trees.places, PLACE)), triangles=triangles)


def in_single(arrays: SceneArrays, extents: np.ndarray, rounding: Rounding) -> SceneArrays:
    """Return a scene in float32, the eye at the origin, also when the `rounding` moves; `extents` are those of
    `minirt.kernel.binning.Projection`, (n, 4)."""
    extents[:, :3] = arrays.colours_and_extents[:, :3]
    light_cones = Rounding(rounding.kernel, rounding.shifts[:3]).rounded(arrays.light_cones.reshape(-1, 5), CONE)
    if arrays.patterns:
        columns = [OTHER] * COLUMNS
        columns[ORIGIN : ORIGIN + 3] = POINT
        rows = rounding.rounded(arrays.patterns.rows, tuple(columns))
        arrays = arrays._replace(patterns=arrays.patterns._replace(rows=rows))
    if arrays.light_grid:
        grids = rounding.rounded(arrays.light_grid.grids, GRID)
        arrays = arrays._replace(light_grid=arrays.light_grid._replace(grids=grids))
    single: SceneArrays = as_single(
        arrays._replace(
            camera=np.concatenate([np.zeros(3), arrays.camera[3:]]),
            lights=rounding.rounded(arrays.lights, (*POINT, OTHER, OTHER, OTHER)),
            colours_and_extents=extents,
            cones=rounding.rounded(arrays.cones, CONE),
            light_cones=light_cones.reshape(arrays.light_cones.shape),
            groups=tuple(map(rounding.group, arrays.groups)),
        )
    )
    return single


def as_single(part: Any) -> Any:
    """Round float64 to the nearest float32 in an array, or in the arrays of a NamedTuple; leave others as they are."""
    if hasattr(part, "_fields"):
        return part._replace(**{name: as_single(each) for name, each in part._asdict().items()})
    if isinstance(part, np.ndarray) and part.dtype == np.float64:
        with np.errstate(over="ignore"):
            return part.astype(np.float32)
    return part
