"""Where a shape ends in the picture, whether it is hidden or not: the kernel's own formula, interpreted, on a grid of
pixels and then on those between which it changes."""

from __future__ import annotations

from math import ceil, hypot

import numpy as np
from numpy.typing import NDArray

from minirt.rendering.queries.pick import covers
from minirt.scene import Camera
from minirt.shapes import Shape
from minirt.shapes.mesh import Mesh
from minirt.viewer.editing.projection import Projection, projection_of, subtract

Places = tuple[NDArray[np.int64], NDArray[np.int64]]  # rows and columns of pixels
Box = tuple[int, int, int, int]  # left, top, right, bottom; right and bottom are outside

MARGIN = 4  # pixels around what a shape may cover


def rims(shape: Shape, camera: Camera, width: int, height: int, rays: int) -> tuple[Places, Places]:
    """The pixels just outside and those just inside of where the shape would show were there nothing else.

    About so many rays are spent on looking for it: with few of them, what is thin may be missed in places.
    """
    if isinstance(shape, Mesh):
        return rims_of(covers(shape, camera, width, height, *np.meshgrid(np.arange(width), np.arange(height))))
    left, top, right, bottom = extent(shape, projection_of(camera, width, height))
    step = max(1, ceil(((right - left) * (bottom - top) / rays) ** 0.5))
    x, y = np.meshgrid(np.arange(left, right + step, step), np.arange(top, bottom + step, step))
    grid = covers(shape, camera, width, height, x, y)
    corners = grid[:-1, :-1], grid[1:, :-1], grid[:-1, 1:], grid[1:, 1:]
    mixed = np.logical_or.reduce(corners) & ~np.logical_and.reduce(corners)
    mixed[:, 1:] |= mixed[:, :-1].copy()  # what changes between two cells belongs to either
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


def rims_of(mask: NDArray[np.bool_]) -> tuple[Places, Places]:
    """The same for a shape that covers those pixels, (h, w)."""
    down, right = np.nonzero(mask[1:] != mask[:-1]), np.nonzero(mask[:, 1:] != mask[:, :-1])
    rows = np.concatenate([down[0], down[0] + 1, right[0], right[0]])
    columns = np.concatenate([down[1], down[1], right[1], right[1] + 1])
    inside = mask[rows, columns]
    return (rows[~inside], columns[~inside]), (rows[inside], columns[inside])


def extent(shape: Shape, seen: Projection) -> Box:
    """What part of the picture a shape may cover."""
    edges = [edge for centre, radius in shape.balls() for edge in disc(centre, radius, seen)]
    if not edges or None in edges:
        return 0, 0, seen.width, seen.height
    x, y = zip(*filter(None, edges), strict=True)
    left, right = (round(min(max(each, 0), seen.width)) for each in (min(x) - MARGIN, max(x) + MARGIN))
    top, bottom = (round(min(max(each, 0), seen.height)) for each in (min(y) - MARGIN, max(y) + MARGIN))
    return left, top, right, bottom


def disc(centre: tuple[float, float, float], radius: float, seen: Projection) -> list[tuple[float, float] | None]:
    """Two opposite corners of a square around what a ball covers; None where it comes near the plane of the eye."""
    depth, middle = seen.depth(centre), seen.pixel(centre)
    if middle is None or depth <= 2 * radius:
        return [None]
    # The farther from the middle of the picture, the longer is what a ball covers: no more than by this.
    slant = hypot(*subtract(centre, seen.eye)) / depth
    reach = seen.width / 2 / hypot(*seen.right) * radius / (depth - radius) * slant
    return [(middle[0] - reach, middle[1] - reach), (middle[0] + reach, middle[1] + reach)]
