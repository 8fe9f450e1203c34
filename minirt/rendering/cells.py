"""Which shapes may be met in which direction from a point: lists for the cells of a grid.

A shape lies within the convex hull of some balls. Seen from a point, in a frame of right, up and forward, a ball covers
an interval of slopes x / z and one of y / z; the rectangle that they span is rounded outward to whole cells.
"""

from __future__ import annotations

import numpy as np

Spread = tuple[np.ndarray, np.ndarray, np.ndarray]  # of each rectangle: first cell, cells across, rows down

MARGIN = 1e-12  # by which balls grow, of their radius and of the coordinates that their place is computed from


def seen_from(origin: np.ndarray, balls: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Centres (n, k, 3) relative to `origin` and radii (n, k), with a margin for rounding, of balls (n, k, 4)."""
    places = balls[..., :3] - origin
    size = np.abs(balls[..., :3]).max(axis=-1) + np.abs(origin).max()
    return places, balls[..., 3] * (1 + MARGIN) + size * MARGIN


def least_distances(places: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """For each shape a distance that no point of it falls below."""
    middle = places.mean(axis=1)
    reach = (np.linalg.norm(places - middle[:, None], axis=-1) + radii).max(axis=1)
    distances: np.ndarray = np.linalg.norm(middle, axis=-1) * (1 - MARGIN) - reach
    return distances


def rectangles(places: np.ndarray, radii: np.ndarray, frames: np.ndarray) -> np.ndarray:
    """Least and greatest slope to the right, then up, (f, n, 4) in each of the frames (f, 3, 3) of right, up and
    forward; from infinity to -infinity for a shape that lies behind."""
    x, y, z = np.moveaxis(np.einsum("nkj,fij->fnki", places, frames), -1, 0)
    behind = z <= -radii
    around = (z <= radii * (1 + 1e-6)) | behind.any(axis=-1, keepdims=True)  # no tangents: it may be anywhere
    intervals = []
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        below = z * z - radii * radii
        for across in (x, y):
            tangent = radii * np.sqrt(across * across + below)
            low = np.where(around, -np.inf, (across * z - tangent) / below)
            high = np.where(around, np.inf, (across * z + tangent) / below)
            intervals += [low.min(axis=-1), high.max(axis=-1)]
    nowhere = np.array([np.inf, -np.inf, np.inf, -np.inf])
    return np.where(behind.all(axis=-1)[..., None], nowhere, np.stack(intervals, axis=-1))


def whole_cells(low: np.ndarray, high: np.ndarray, cells: int) -> tuple[np.ndarray, np.ndarray]:
    """First cell and number of cells of intervals that are given in units of cells; none outside of the grid."""
    first = np.clip(np.floor(low), 0, cells).astype(np.int64)
    last = np.clip(np.floor(high), -1, cells - 1).astype(np.int64)
    return first, np.maximum(last + 1 - first, 0)


def lists(spread: Spread, across: int, cells: int) -> tuple[np.ndarray, np.ndarray]:
    """For each of so many cells, `across` of them in a row, the rectangles that cover it, in their order:
    `members[starts[c]:starts[c + 1]]`."""
    first, wide, high = spread
    count = wide * high
    which = np.repeat(np.arange(len(count)), count)
    inside = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
    down, right = np.divmod(inside, wide[which])
    cell = first[which] + down * across + right
    starts = np.concatenate([[0], np.cumsum(np.bincount(cell, minlength=cells))])
    return starts, which[np.argsort(cell, kind="stable")]
