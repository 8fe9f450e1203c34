"""Views: the shapes that a camera sees, in arrays that follow it when it moves; and packed scenes in float32.

float32 is less precise, with twice as many rays per SIMD register. Everything is moved so that the eye is the origin
before it is rounded, so that whatever is near the eye is precise. Bounds used for culling are rounded to the safe side.
"""

from __future__ import annotations

from copy import copy
from struct import pack_into
from typing import Any, NamedTuple

import numpy as np

from minirt.kernel.beams import CENTRE
from minirt.kernel.moving_camera import Followers
from minirt.kernel.pixels import PACKET_HEIGHT
from minirt.kernel.scene_arrays import Group, SceneArrays, kind_of, row_axes, row_type
from minirt.kernel.shading.patterns import COLUMNS, ORIGIN
from minirt.lanes import width
from minirt.rendering.frame import frame_rays, sample_positions
from minirt.rendering.packing.camera import (
    Place,
    camera_frame,
    camera_numbers,
    packet_places,
    pixel_rays,
    radius_and_focus,
    slopes_at_edges,
)
from minirt.rendering.packing.light_buffers import has_cones
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.packing.visibility import CROSSED, STILL, BinnedShapes, Bins, Run, screen_grid, square_edge
from minirt.scene import Camera, Scene

SPARE = 0.25  # of the lists of a camera that moves


class PackedScene(NamedTuple):
    """A scene, and its arrays for a picture or a rectangle of one."""

    scene: Scene
    place: Place
    arrays: SceneArrays


class View:
    """The shapes in the tiles of a picture, or of a rectangle of one, and all else that depends on the camera."""

    bins: Bins
    rays: np.ndarray | None  # of one sample, as of `minirt.rendering.frame.frame_rays`; None where a lens turns them

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
        """Prepare lists for shapes in the picture of a camera, or a rectangle of it, in "double" or "single" precision.

        `kernel` has the functions that bin, compiled or interpreted; `lens` are the camera's `lens_numbers`, or None.
        The bins of a `spare` view are used again where they fit. No array follows the camera before `complete`.
        """
        *_, crop = place
        self.size = crop.width, crop.height  # of the whole picture
        radius, per_focus = radius_and_focus(lens)
        if radius:
            shapes = copy(shapes)
            shapes.balls = blurred_balls(shapes.balls, camera_numbers(camera, *self.size), radius, per_focus)
        extents = np.zeros((len(shapes.slots) if precision == "single" else 0, 4), np.float32)  # float64 needs none
        self.square = square_edge(shapes, width(extents if len(extents) else shapes.balls) // PACKET_HEIGHT)
        grid = screen_grid(*slopes_at_edges(camera, *self.size), place, self.square)
        if spare and spare.bins.fit(shapes, grid, radius) and len(spare.bins.arrays.extents) == len(extents):
            self.bins = spare.bins
        else:
            self.bins = Bins(kernel, shapes, grid, radius, radius * per_focus, extents=extents)
        self.bins.followers, self.bins.pack = STILL, None

    def look(self, camera: Camera, run: Run | None) -> BinnedShapes:
        """Bin the shapes that a camera sees into tiles."""
        right, (x, y, z), forward = camera_frame(camera)
        self.bins.see_from((*camera.position, *right, -x, -y, -z, *forward), run, SPARE)
        return BinnedShapes(self.bins.starts, self.bins.members, self.bins.arrays.cones)

    def complete(self, arrays: SceneArrays, is_single: bool) -> SceneArrays:
        """Let the arrays of a scene follow the camera; return them or, if it `is_single`, their copies in float32.

        `rays` are set.
        """
        self.rounding, bins = Rounding(), self.bins
        single = in_single(arrays, bins.arrays.extents, self.rounding) if is_single else arrays
        rays = frame_rays(single, 1).astype(np.float64)
        followed = self.rounding.rounded(rays.reshape(-1, 1), (OTHER,)).reshape(1, -1) if is_single else rays
        self.rays = None if arrays.lens is not None else followed
        tables = [(a.ctypes.data, *a.shape, first, b.ctypes.data) for a, first, b in self.rounding.tables]
        places = np.ascontiguousarray(packet_places(width(single.camera), sample_positions(1))[0].T)
        kinds, shifts = np.array(self.rounding.kinds, np.int64), np.append(np.zeros(4), MARGIN)  # the eye comes first
        to_round = np.array(tables, np.int64).reshape(-1, 5), kinds, shifts
        bins.followers, bins.pack = Followers(arrays.camera, places, rays[0], *to_round), None
        bins.kernel.follow(bins.followers)
        return single

    def follow(self, camera: Camera, run: Run | None) -> bool:
        """Let all arrays follow a camera; False where that takes other arrays, and these are spoilt."""
        members = self.bins.members
        pack_into("12d", self.bins.followers.camera.data, 0, *pixel_rays(camera, *self.size))
        self.look(camera, run)
        return members is self.bins.members and not self.bins.arrays.found[CROSSED]


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
    """Tables that are rounded to float32, relative to an eye that moves: see `Followers`."""

    def __init__(self) -> None:
        self.tables: list[tuple[np.ndarray, int, np.ndarray]] = []  # numbers, number of their first kind, and rounded
        self.kinds: list[int] = []

    def rounded(self, table: np.ndarray, columns: tuple[int, ...]) -> np.ndarray:
        """Return an array that a table of float64, (n, c), is to be rounded into. `columns` tells what each one holds:
        a part of `POINT`, `COSINE` or `OTHER`."""
        into = np.zeros(table.shape, np.float32)
        self.tables.append((table, len(self.kinds), into))
        self.kinds += columns
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
    """Return a scene in float32, the eye at the origin.

    Most arrays are not written yet: they are added to the `rounding`, which follows the eye. `extents`, (n, 4), those
    of `minirt.kernel.rectangles.BinningArrays`, become its `colours_and_extents`: here the colours are written.
    """
    extents[:, :3] = arrays.colours_and_extents[:, :3]
    light_cones = np.zeros(arrays.light_cones.shape, np.float32)
    if has_cones(*light_cones.shape[:2]):
        with np.errstate(over="ignore"):
            np.subtract(arrays.light_cones, (0.0, 0.0, 0.0, MARGIN, 0.0), light_cones, casting="same_kind")
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
            camera=rounding.rounded(arrays.camera[None], (*POINT, *(OTHER,) * 11))[0],
            lights=rounding.rounded(arrays.lights, (*POINT, OTHER, OTHER, OTHER)),
            colours_and_extents=extents,
            cones=rounding.rounded(arrays.cones, CONE),
            light_cones=light_cones,
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


def all_but_pose(scene: Scene) -> tuple[Any, ...]:
    """Return all of a scene, beside its shapes, that a camera leaves as it is when it moves and turns."""
    seen_by = scene.camera
    rest = scene.lights, scene.ambient, scene.background, scene.file
    return *rest, seen_by.fov, seen_by.tone, seen_by.exposure, seen_by.lens
