"""Where meshes are in a picture, by the edges of what faces the eye instead of by rays.

Seen from a point, the triangles that face it cover a pixel as often as the loops of edges around them wind about it; an
edge between two such triangles is in two loops that cancel. Only those edges are drawn where that is not so, some
hundred of a hundred thousand: each row of pixels is a running sum of the edges that cross it.
"""

from __future__ import annotations

import numpy as np

from minirt.rendering.packing.camera import camera_numbers, pixel_rays
from minirt.scene import Camera
from minirt.shapes.mesh import Mesh


def covered_pixels(mesh: Mesh, camera: Camera, width: int, height: int) -> np.ndarray | None:
    """Which pixels, (h, w), show the mesh in their middle where nothing is in front of it; None where some of it is
    beside or behind the eye."""
    made = mesh.triangles
    numbers = pixel_rays(camera_numbers(camera, width, height), width, height)
    eye, corner, across, down = numbers.reshape(4, 3)
    x, y, depth = np.linalg.inv(np.stack([across, down, corner], axis=1)) @ (mesh.placed(made.points) - eye).T
    if depth[made.used].min() <= 0:
        return None
    with np.errstate(all="ignore"):  # points that no triangle has may be anywhere
        x, y = x / depth, y / depth
    found = np.zeros((height, width), bool)
    for facing in facing_triangles(x, y, made.corners)[: 1 if made.closed else 2]:  # behind what is closed is its other side
        start, end = silhouette_edges(facing, made.corners, made.edges)
        found |= winding_numbers(x[start], y[start], x[end], y[end], width, height) != 0
    return found


def facing_triangles(x: np.ndarray, y: np.ndarray, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which triangles are seen from either side."""
    (ax, bx, cx), (ay, by, cy) = x[corners].T, y[corners].T
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    return area > 0, area < 0


def silhouette_edges(facing: np.ndarray, corners: np.ndarray, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The points where the edges of triangles begin and end that do not cancel. `edges` (m, 3) has the numbers of the
    edges of each triangle, of which those with the same two ends have the same."""
    mine = corners[facing]
    start, end, which = mine.ravel(), np.roll(mine, -1, axis=1).ravel(), edges[facing].ravel()
    balance = np.bincount(which, np.sign(end - start), edges.max() + 1)
    loose = balance[which] != 0
    return start[loose], end[loose]


def winding_numbers(ax: np.ndarray, ay: np.ndarray, bx: np.ndarray, by: np.ndarray, width: int, height: int) -> np.ndarray:
    """How often edges wind about the middle of each pixel, (h, w)."""
    # The rows whose middle lies between the ends, the lower of which counts and the higher does not.
    first, last = (np.clip(np.ceil(each - 0.5), 0, height).astype(np.int64) for each in (ay, by))
    rows = np.abs(last - first)
    which = np.repeat(np.arange(len(rows)), rows)
    row = np.minimum(first, last)[which] + np.arange(len(which)) - np.repeat(np.cumsum(rows) - rows, rows)
    at = ax[which] + (row + 0.5 - ay[which]) * (bx - ax)[which] / (by - ay)[which]
    column = np.clip(np.ceil(at - 0.5), 0, width).astype(np.int64)
    turns = np.bincount(row * (width + 1) + column, np.sign(last - first)[which], height * (width + 1))
    around: np.ndarray = np.cumsum(np.rint(turns).reshape(height, width + 1)[:, :width], axis=1)
    return around
