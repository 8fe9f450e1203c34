"""The cells of a lamp that sees a crowd of shapes from outside: only ahead, where those are, and so much the finer.

Shapes beside the crowd are left out of it where they are few: they are in the list of all directions elsewhere.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from minirt.kernel.culling.binning import Grid
from minirt.kernel.culling.light_buffer import FRUSTUM_FACTOR
from minirt.rendering.packing.shape_arrays import ShapeArrays

CROWD = 1000  # shapes at least: with fewer a cube takes less time
BESIDE = 8  # shapes at most
SPREAD = 0.5  # of the angle that cells have on average: a cell's list holds for directions so close to one in it
WIDEST = 1.0  # slope at the edges of the square: where more would be needed there is a cube
FINEST = 2.0**-18  # slope that a cell has at least: float32 could not tell closer directions apart
BORDER = 4  # cells on each side for what of a shape at the edge of the crowd rounding and `SPREAD` may take out of it


class Cluster(NamedTuple):
    """A ball around most of the shapes."""

    middle: np.ndarray
    radius: float


def cluster(tables: ShapeArrays) -> Cluster | None:
    """The crowd of a scene; None where there is none."""
    boxes = np.delete(tables.boxes, tables.flat, axis=0) if len(tables.flat) else tables.boxes
    if len(boxes) < CROWD:
        return None
    middle = boxes[:, :3].mean(axis=0)
    away = boxes[:, :3] - middle
    reach = np.sqrt(np.einsum("ij,ij->i", away, away)) + np.sqrt(3) * boxes[:, 3]
    last = len(reach) - 1 - BESIDE
    return Cluster(middle, float(np.partition(reach, last)[last]))


def square_ahead(found: Cluster | None, lamp: np.ndarray, grid: int) -> Grid | None:
    """The cells ahead of a lamp; None where a cube with `grid` cells along an edge should be around it."""
    if found is None:
        return None
    way = found.middle - lamp
    distance = float(np.linalg.norm(way))
    cells = FRUSTUM_FACTOR * grid
    if not found.radius < distance / np.sqrt(1 + WIDEST**-2):
        return None
    slope = found.radius / np.sqrt(distance**2 - found.radius**2)
    size = max(slope / (cells / 2 - BORDER), FINEST)
    edge = size * (cells / 2 + 2)
    forward = way / distance
    across = np.cross(forward, np.eye(3)[np.abs(forward).argmin()])
    across /= np.linalg.norm(across)
    frames = np.stack([across, np.cross(forward, across), forward])[None]
    # An angle changes a slope by at most its product with both roots, where both slopes are those at the edge.
    margin = 1.02 * SPREAD * np.sqrt(1 + edge**2) * np.sqrt(1 + 2 * edge**2)
    half = cells / 2
    return Grid(frames, cells, cells, 1 / size, half, 1 / size, half, margin, 6 * grid * grid, cells * cells)
