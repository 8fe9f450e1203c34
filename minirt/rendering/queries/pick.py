"""Questions about pixels and shapes: what a pixel shows, where, which pixels a shape covers, how far it can fall.

Rays are cast by the interpreted formulas of the kernel, see `minirt.rendering.packing.ray_casting`.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from minirt.fields import Triple
from minirt.kernel.projection import Grid, projected_rectangle
from minirt.kernel.scene_arrays import kind_of_packed
from minirt.kernel.trace import COINCIDENT, OWNER, closer_hit
from minirt.lanes import Vec
from minirt.rendering.packing.camera import camera_frame, pixel_rays, slopes_at_edges
from minirt.rendering.packing.ray_casting import camera_ray, cast, distances_of, hit_distances, packed_columns
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.scene import Camera, Scene
from minirt.shapes import Mesh, Shape
from minirt.shapes.shape import Bounds

Picked = tuple[Shape | None, Triple | None]  # a shape and a point on it; None for both where the background is
COUNT = 33  # rays along a side of a footprint: odd, so that one is in the middle
COARSE = 9  # where a mesh takes part, whose triangles are all tested
RAYS = 4096  # at once: their numbers fit a processor's cache, which takes half of the time
START = 1 / 1024  # of the shape's height: how far above its top the rays begin, so that they meet a surface there


def pick(scene: Scene, width: int, height: int, x: int, y: int, shape_arrays: ShapeArrays | None = None) -> Picked:
    """Return the shape at the centre of pixel x, y of a picture of that size, and the point on it, or None for both.

    `shape_arrays` are brought up to date; those of the last picture save the time of packing the shapes.
    """
    shape_arrays = shape_arrays or ShapeArrays()
    shape_arrays.update(*scene.runs)
    origin, direction = camera_ray(scene.camera, width, height, x + 0.5, y + 0.5)
    distance = hit_distances(shape_arrays, origin, direction)
    near = distance <= distance.min(initial=np.inf) * (1 + 2 * COINCIDENT)
    _, extents = shape_arrays.primitive_boxes()
    closest: Any = *np.array([[np.inf], [-1.0], [0.0]]), -1  # distance, primitive, its extent, and the last hit
    for index in np.flatnonzero(np.isfinite(distance) & near).tolist():  # where they coincide the kernel's rule decides
        group, row = shape_arrays.slots[index]
        packed = packed_columns(shape_arrays.rows[group][row : row + 1])
        extent, is_hit = extents[index], np.ones(1, bool)
        with np.errstate(all="ignore"):
            closest = closer_hit(packed, index, extent, is_hit, distance[[index]], origin, direction, closest)
    primitive = int(closest[OWNER][0])
    if primitive < 0:
        return None, None
    point = origin + float(distance[primitive]) * direction
    return scene.shapes[shape_arrays.owner[primitive]], (float(point.x), float(point.y), float(point.z))


def surface_normal(shape: Shape, point: Triple, direction: Triple) -> Triple:
    """The unit normal of a shape at a point of its surface, towards where a ray of this direction comes from."""
    with np.errstate(all="ignore"):
        if isinstance(shape, Mesh):
            t = cast(shape.pack(), Vec(*point) - Vec(*direction), Vec(*direction))
            shape = shape.some(np.array([np.argmin(np.abs(t - 1.0))]))
        packed = shape.pack()
        _, normal = kind_of_packed(type(packed)).surface(packed, Vec(*point))
    x, y, z = (float(np.ravel(part)[0]) for part in (normal.x, normal.y, normal.z))
    facing = -1.0 if x * direction[0] + y * direction[1] + z * direction[2] > 0 else 1.0
    return facing * x + 0.0, facing * y + 0.0, facing * z + 0.0


def first_hit(shape: Shape, origin: Triple, direction: Triple) -> tuple[Triple, Triple] | None:
    """The point where a ray meets a shape, and the unit normal there, towards the origin; None where it misses."""
    distance = float(distances_of(shape, Vec(*np.array(origin)), Vec(*np.array(direction))).min())
    if not np.isfinite(distance):
        return None
    x, y, z = (start + distance * part for start, part in zip(origin, direction, strict=True))
    return (x, y, z), surface_normal(shape, (x, y, z), direction)


def covers(shape: Shape, camera: Camera, width: int, height: int, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Whether a shape covers the centres of pixels x, y, with no other shape in front; False everywhere for a mesh that
    reaches beside or behind the eye."""
    if isinstance(shape, Mesh):
        covered = covered_pixels(shape, camera, width, height)
        inside = (x >= 0) & (x < width) & (y >= 0) & (y < height)
        return inside & (covered is not None and covered[np.clip(y, 0, height - 1), np.clip(x, 0, width - 1)])
    x, y = np.broadcast_arrays(x, y)
    packed, places = shape.pack(), np.stack([x.ravel() + 0.5, y.ravel() + 0.5])
    chunks = (places[:, start : start + RAYS] for start in range(0, max(x.size, 1), RAYS))
    parts = [cast(packed, *camera_ray(camera, width, height, *chunk), limit=np.inf) < np.inf for chunk in chunks]
    return np.concatenate(parts).reshape(x.shape)


def enclosing_rectangle(
    shape: Shape, camera: Camera, width: int, height: int, margin: float
) -> tuple[int, int, int, int]:
    """Return left, top, right and bottom, in pixels, of the rectangle of the picture that encloses a shape and a margin
    around it; the whole picture for an unbounded shape."""
    spheres = np.array([(*centre, radius) for centre, radius in shape.balls()])
    if not len(spheres):
        return 0, 0, width, height
    right, up, forward = camera_frame(camera)
    across, down = slopes_at_edges(camera, width, height)
    x, y = width / 2, height / 2
    frames = np.array([[right, np.negative(up), forward]])
    grid = Grid(frames, width, height, x / across, x, y / down, y, margin, width * height)
    left, top, columns, rows = projected_rectangle(camera.position, grid, 0, spheres, 0, len(spheres), 0.0)
    return left, top, left + columns, top + rows


def clearance(shape: Shape, others: Iterable[Shape]) -> tuple[float, Shape | None]:
    """Return how far a bounded shape can fall until it meets one of `others`, and that one.

    The distance is negative if the shape sinks into the other one; it is infinite, and there is no other one, if none
    lies beneath its top. Vertical rays sample the shape's footprint. Their middle one is exact, so that shapes whose
    middles lie above each other touch; elsewhere the error is of the second order in the spacing.
    """
    box = shape.bounds()
    assert box
    near = [other for other in others if is_near(box, other.bounds())]
    count = COARSE if any(isinstance(each, Mesh) for each in (shape, *near)) else COUNT
    (west, bottom, south), (east, top, north) = box
    share = (np.arange(count) + 0.5) / count
    x, z = (each.ravel() for each in np.meshgrid(west + (east - west) * share, south + (north - south) * share))
    height = top - bottom or east - west  # of a flat shape its width
    start = top + START * height
    underside = bottom - height + vertical(shape, x, bottom - height, z, 1.0)  # y of the lowest points
    gap, support = np.inf, None
    for other in near:
        with np.errstate(invalid="ignore"):  # where rays miss both
            gaps = underside - (start - vertical(other, x, start, z, -1.0))
        least = float(np.where(np.isfinite(gaps), gaps, np.inf).min())
        gap, support = (least, other) if least < gap else (gap, support)
    return gap, support


def is_near(box: Bounds, other: Bounds | None) -> bool:
    """Whether a box may lie beneath another: their footprints overlap and it does not begin above."""
    if other is None:
        return True
    (low, high), (other_low, other_high) = box, other
    overlap = all(other_low[axis] <= high[axis] and other_high[axis] >= low[axis] for axis in (0, 2))
    return overlap and other_low[1] < high[1]


def vertical(shape: Shape, x: np.ndarray, y: float, z: np.ndarray, up: float) -> np.ndarray:
    """Distances along vertical rays, up or down, from x, y, z to a shape; infinite where they miss it."""
    nothing = np.zeros_like(x)
    return distances_of(shape, Vec(x, nothing + y, z), Vec(nothing, nothing + up, nothing))


def covered_pixels(mesh: Mesh, camera: Camera, width: int, height: int) -> np.ndarray | None:
    """Whether the mesh covers the centre of each pixel, (h, w), with no other shape in front; None where some of it is
    beside or behind the eye.

    Seen from a point, the number of triangles facing it that cover a pixel is the winding number of the loops of their
    edges about the pixel. An edge between two such triangles is in two loops that cancel. So only the edges that do not
    cancel are drawn, some hundred of a hundred thousand: a row of pixels is a running sum of the edges that cross it.
    """
    triangles = mesh.triangles
    eye, corner, across, down = np.reshape(pixel_rays(camera, width, height), (4, 3))
    x, y, depth = np.linalg.inv(np.stack([across, down, corner], axis=1)) @ (mesh.placed(triangles.points) - eye).T
    if depth.min() <= 0:
        return None
    with np.errstate(all="ignore"):  # points that no triangle has may be anywhere
        x, y = x / depth, y / depth
    covered = np.zeros((height, width), bool)
    (ax, bx, cx), (ay, by, cy) = x[triangles.corners].T, y[triangles.corners].T
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    # Triangles seen from their front, then those seen from their back, which a closed mesh hides behind its front.
    for facing in (area > 0, area < 0)[: 1 if triangles.closed else 2]:
        start, end = silhouette_edges(facing, triangles.corners, triangles.edges)
        covered |= winding_numbers(x[start], y[start], x[end], y[end], width, height) != 0
    return covered


def silhouette_edges(facing: np.ndarray, corners: np.ndarray, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Start and end points of the edges of the triangles in `facing` that do not cancel.

    `edges` (m, 3) has the numbers of the edges of each triangle; edges with the same two ends have the same number.
    """
    faces = corners[facing]
    start, end, edge = faces.ravel(), np.roll(faces, -1, axis=1).ravel(), edges[facing].ravel()
    balance = np.bincount(edge, np.sign(end - start), edges.max() + 1)
    remaining = balance[edge] != 0
    return start[remaining], end[remaining]


def winding_numbers(
    ax: np.ndarray, ay: np.ndarray, bx: np.ndarray, by: np.ndarray, width: int, height: int
) -> np.ndarray:
    """The winding number of edges from points a to b about the centre of each pixel, (h, w)."""
    # The rows whose centre lies between the ends; the lower end counts, the higher does not.
    first, last = (np.clip(np.ceil(each - 0.5), 0, height).astype(np.int64) for each in (ay, by))
    rows = np.abs(last - first)
    edge = np.repeat(np.arange(len(rows)), rows)
    row = np.minimum(first, last)[edge] + np.arange(len(edge)) - np.repeat(np.cumsum(rows) - rows, rows)
    crossing = ax[edge] + (row + 0.5 - ay[edge]) * (bx - ax)[edge] / (by - ay)[edge]
    column = np.clip(np.ceil(crossing - 0.5), 0, width).astype(np.int64)
    turns = np.bincount(row * (width + 1) + column, np.sign(last - first)[edge], height * (width + 1)).astype(np.int16)
    return np.cumsum(turns.reshape(height, width + 1)[:, :width], axis=1, dtype=np.int16)
