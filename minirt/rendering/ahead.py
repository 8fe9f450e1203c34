"""The cells ahead of a lamp that sees all that has an end from outside."""

from __future__ import annotations

from itertools import product

import numpy as np

from minirt.kernel.cells import AHEAD
from minirt.kernel.lists import Grid
from minirt.rendering.tables import Tables

SPREAD = 0.5  # of the angle that cells have on average: a cell's list holds for directions so close to one in it
WIDEST = 1.0  # slope at the edges of the square: a cube is used where it would be more


def square_ahead(tables: Tables, lamp: np.ndarray, grid: int) -> Grid | None:
    low, high, radius = tables.crowd
    middle = (low + high) / 2
    way = middle - lamp
    distance = float(np.linalg.norm(way))
    if not distance > radius or not np.isfinite(distance):
        return None
    forward = way / distance
    across = np.cross(forward, np.eye(3)[np.argmin(np.abs(forward))])
    across /= np.linalg.norm(across)
    frame = np.stack([across, np.cross(forward, across), forward])
    x, y, z = frame @ (np.array(list(product(*zip(low, high)))) - lamp).T
    slope = radius / np.sqrt(distance**2 - radius**2)
    if z.min() > 0:
        slope = min(slope, max(np.abs(x / z).max(), np.abs(y / z).max()))
    cells = AHEAD * grid
    slope *= 1 + 8 / cells
    if slope > WIDEST:
        return None
    scale = cells / 2 / slope
    margin = 1.02 * SPREAD * np.sqrt(1 + slope**2) * np.sqrt(1 + 2 * slope**2)
    return Grid(frame[None], cells, cells, scale, cells / 2, scale, cells / 2, margin, 6 * grid * grid, cells * cells)
