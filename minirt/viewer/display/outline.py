"""Outline of a shape in the picture, whether it is hidden or not.

The hit formula of the kernel, interpreted by Python, is evaluated on a coarse grid of pixels first and then on all
pixels of the cells in which coverage changes.
"""

from __future__ import annotations

from math import ceil, hypot

import numpy as np
from numpy.typing import NDArray

from minirt.rendering.queries.pick import covers
from minirt.scene import Camera
from minirt.shapes import Shape
from minirt.shapes.mesh import Mesh
from minirt.viewer.editing.projection import Projection, projection_of, subtract

PixelIndices = tuple[NDArray[np.int64], NDArray[np.int64]]  # rows and columns of pixels
Box = tuple[int, int, int, int]  # left, top, right, bottom; right and bottom are exclusive

MARGIN = 4  # pixels around the projected bounds of a shape


def outline_pixels(
    shape: Shape, camera: Camera, width: int, height: int, rays: int
) -> tuple[PixelIndices, PixelIndices]:
    """Return the pixels just outside and just inside the silhouette that the shape would have alone in the scene.

    The coarse grid has about `rays` points: with few of them, parts of thin shapes may be missed.
    """
    if isinstance(shape, Mesh):
        return mask_outline(covers(shape, camera, width, height, *np.meshgrid(np.arange(width), np.arange(height))))
    left, top, right, bottom = screen_bounds(shape, projection_of(camera, width, height))
    step = max(1, ceil(((right - left) * (bottom - top) / rays) ** 0.5))
    x, y = np.meshgrid(np.arange(left, right + step, step), np.arange(top, bottom + step, step))
    grid = covers(shape, camera, width, height, x, y)
    corners = grid[:-1, :-1], grid[1:, :-1], grid[:-1, 1:], grid[1:, 1:]
    mixed = np.logical_or.reduce(corners) & ~np.logical_and.reduce(corners)
    mixed[:, 1:] |= mixed[:, :-1].copy()  # an edge on the border of two cells belongs to both
    mixed[1:] |= mixed[:-1].copy()
    rows, columns = (step * each[:, None, None] for each in np.nonzero(mixed))
    reach = np.arange(-1, step + 1)
    y = np.clip(top + rows + reach[:, None], 0, height - 1)
    x = np.clip(left + columns + reach, 0, width - 1)
    y, x = np.broadcast_arrays(y, x)
    mask = covers(shape, camera, width, height, x, y)
    around = mask[:, :-2, 1:-1], mask[:, 2:, 1:-1], mask[:, 1:-1, :-2], mask[:, 1:-1, 2:]
    middle = mask[:, 1:-1, 1:-1]
    outside, inside = np.logical_or.reduce(around) & ~middle, middle & ~np.logical_and.reduce(around)
    y, x = y[:, 1:-1, 1:-1], x[:, 1:-1, 1:-1]
    return (y[outside], x[outside]), (y[inside], x[inside])


def mask_outline(mask: NDArray[np.bool_]) -> tuple[PixelIndices, PixelIndices]:
    """Return the pixels just outside and just inside of a mask, (h, w), that is true where a shape is."""
    down, right = np.nonzero(mask[1:] != mask[:-1]), np.nonzero(mask[:, 1:] != mask[:, :-1])
    rows = np.concatenate([down[0], down[0] + 1, right[0], right[0]])
    columns = np.concatenate([down[1], down[1], right[1], right[1] + 1])
    inside = mask[rows, columns]
    return (rows[~inside], columns[~inside]), (rows[inside], columns[inside])


def screen_bounds(shape: Shape, view: Projection) -> Box:
    """Return a box of pixels that encloses the projection of a shape."""
    edges = [edge for centre, radius in shape.balls() for edge in sphere_bounds(centre, radius, view)]
    if not edges or None in edges:
        return 0, 0, view.width, view.height
    x, y = zip(*filter(None, edges), strict=True)
    left, right = (round(min(max(each, 0), view.width)) for each in (min(x) - MARGIN, max(x) + MARGIN))
    top, bottom = (round(min(max(each, 0), view.height)) for each in (min(y) - MARGIN, max(y) + MARGIN))
    return left, top, right, bottom


def sphere_bounds(
    centre: tuple[float, float, float], radius: float, view: Projection
) -> list[tuple[float, float] | None]:
    """Return two opposite corners of a square that encloses a projected sphere; None if it is near the eye's plane."""
    depth, middle = view.depth(centre), view.pixel(centre)
    if middle is None or depth <= 2 * radius:
        return [None]
    # A projected sphere is an ellipse, which is longer the farther it is from the picture's centre; this bounds it.
    slant = hypot(*subtract(centre, view.eye)) / depth
    reach = view.width / 2 / hypot(*view.right) * radius / (depth - radius) * slant
    return [(middle[0] - reach, middle[1] - reach), (middle[0] + reach, middle[1] + reach)]
