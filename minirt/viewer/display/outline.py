"""Outline of a shape, whether other shapes hide it or not."""

from __future__ import annotations

from functools import lru_cache
from math import ceil

import numpy as np
from numpy.typing import NDArray

from minirt.rendering.queries.pick import covers, enclosing_rectangle
from minirt.scene import Camera
from minirt.shapes import Mesh, Shape

MARGIN = 4  # pixels around the projected bounds of a shape
KEPT = 16  # outlines of selected shapes that do not change

PixelIndices = tuple[NDArray[np.int64], NDArray[np.int64]]  # rows and columns of pixels


@lru_cache(maxsize=KEPT)  # an outline takes a millisecond or two
def outline_pixels(
    shape: Shape, camera: Camera, width: int, height: int, rays: int
) -> tuple[PixelIndices, PixelIndices]:
    """Return the pixels just outside and just inside the silhouette that the shape would have alone in the scene.

    What the shape covers is found on a coarse grid of about `rays` points, and then for all pixels of the cells whose
    corners differ. With few points, parts of thin shapes may be missed.
    """
    left, top, right, bottom = enclosing_rectangle(shape, camera, width, height, MARGIN)
    if isinstance(shape, Mesh):  # all pixels of a mesh cost as much as a few
        y, x = np.ix_(np.arange(top - 1, bottom + 1), np.arange(left - 1, right + 1))
        y, x = y[None], x[None]  # one block
    else:
        step = max(1, ceil(((right - left) * (bottom - top) / rays) ** 0.5))
        x, y = np.meshgrid(np.arange(left, right + step, step), np.arange(top, bottom + step, step))
        grid = covers(shape, camera, width, height, x, y)
        corners = grid[:-1, :-1], grid[1:, :-1], grid[:-1, 1:], grid[1:, 1:]
        mixed = np.logical_or.reduce(corners) & ~np.logical_and.reduce(corners)
        rows, columns = (step * each[:, None, None] for each in np.nonzero(mixed))
        reach = np.arange(-1, step + 2)  # an edge on the border of two cells belongs to both
        y, x = top + rows + reach[:, None], left + columns + reach
    # From here on arrays are (blocks, rows, columns): a block is a cell with a pixel around it.
    y, x = np.clip(y, 0, height - 1), np.clip(x, 0, width - 1)
    mask = covers(shape, camera, width, height, x, y)
    around = mask[:, :-2, 1:-1], mask[:, 2:, 1:-1], mask[:, 1:-1, :-2], mask[:, 1:-1, 2:]
    middle = mask[:, 1:-1, 1:-1]
    outside, inside = np.logical_or.reduce(around) & ~middle, middle & ~np.logical_and.reduce(around)
    y, x = (each[:, 1:-1, 1:-1] for each in np.broadcast_arrays(y, x))
    return (y[outside], x[outside]), (y[inside], x[inside])
