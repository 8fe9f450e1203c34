"""Pixels that a mesh covers, found from its silhouette edges and winding numbers instead of by rays.

Seen from a point, the number of triangles facing it that cover a pixel is the winding number of the loops of their
edges about the pixel. An edge between two such triangles is in two loops that cancel. So only the edges that do not
cancel are drawn, some hundred of a hundred thousand: each row of pixels is a running sum of the edges that cross it.
"""

from __future__ import annotations

import numpy as np

from minirt.rendering.packing.camera import camera_numbers, pixel_rays
from minirt.scene import Camera
from minirt.shapes.mesh import Mesh


def covered_pixels(mesh: Mesh, camera: Camera, width: int, height: int) -> np.ndarray | None:
    """Whether the mesh covers the centre of each pixel, (h, w), with no other shape in front; None where some of it is
    beside or behind the eye."""
    triangles = mesh.triangles
    numbers = pixel_rays(camera_numbers(camera, width, height), width, height)
    eye, corner, across, down = numbers.reshape(4, 3)
    x, y, depth = np.linalg.inv(np.stack([across, down, corner], axis=1)) @ (mesh.placed(triangles.points) - eye).T
    if depth[triangles.used].min() <= 0:
        return None
    with np.errstate(all="ignore"):  # points that no triangle has may be anywhere
        x, y = x / depth, y / depth
    covered = np.zeros((height, width), bool)
    # The back of a closed mesh lies behind its front.
    for facing in facing_triangles(x, y, triangles.corners)[: 1 if triangles.closed else 2]:
        start, end = silhouette_edges(facing, triangles.corners, triangles.edges)
        covered |= winding_numbers(x[start], y[start], x[end], y[end], width, height) != 0
    return covered


def facing_triangles(x: np.ndarray, y: np.ndarray, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Whether each triangle is seen from its front, and whether from its back."""
    (ax, bx, cx), (ay, by, cy) = x[corners].T, y[corners].T
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    return area > 0, area < 0


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
    turns = np.bincount(row * (width + 1) + column, np.sign(last - first)[edge], height * (width + 1))
    winding: np.ndarray = np.cumsum(np.rint(turns).reshape(height, width + 1)[:, :width], axis=1)
    return winding
