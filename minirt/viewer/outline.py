"""Where a shape ends in the picture, whether it is hidden or not: the kernel's own formula, interpreted, on a grid of
pixels and then on those between which it changes."""

from __future__ import annotations

from math import ceil, hypot

import numpy as np
from numpy.typing import NDArray

from minirt.lanes import Vec, unit
from minirt.shapes import KINDS, Shape
from minirt.viewer.lens import Lens, minus

Mask = NDArray[np.bool_]
Places = tuple[NDArray[np.int64], NDArray[np.int64]]  # rows and columns of pixels
Box = tuple[int, int, int, int]  # left, top, right, bottom; right and bottom are outside

MARGIN = 4  # pixels around what a shape may cover


def rims(shape: Shape, lens: Lens, rays: int) -> tuple[Places, Places]:
    """The pixels just outside and those just inside of where the shape would show were there nothing else.

    About so many rays are spent on looking for it: with few of them, what is thin may be missed in places.
    """
    left, top, right, bottom = extent(shape, lens)
    step = max(2, ceil(((right - left) * (bottom - top) / rays) ** 0.5))
    grid = hits(shape, lens, *np.meshgrid(np.arange(left, right + step, step), np.arange(top, bottom + step, step)))
    corners = grid[:-1, :-1], grid[1:, :-1], grid[:-1, 1:], grid[1:, 1:]
    mixed = np.logical_or.reduce(corners) & ~np.logical_and.reduce(corners)
    mixed[:, 1:] |= mixed[:, :-1].copy()  # what changes between two cells belongs to either
    mixed[1:] |= mixed[:-1].copy()
    rows, columns = (step * each[:, None, None] for each in np.nonzero(mixed))
    reach = np.arange(-1, step + 1)
    y = np.clip(top + rows + reach[:, None], 0, lens.height - 1)
    x = np.clip(left + columns + reach, 0, lens.width - 1)
    y, x = np.broadcast_arrays(y, x)
    mask = hits(shape, lens, x, y)
    around = mask[:, :-2, 1:-1], mask[:, 2:, 1:-1], mask[:, 1:-1, :-2], mask[:, 1:-1, 2:]
    middle = mask[:, 1:-1, 1:-1]
    outside, inside = np.logical_or.reduce(around) & ~middle, middle & ~np.logical_and.reduce(around)
    y, x = y[:, 1:-1, 1:-1], x[:, 1:-1, 1:-1]
    return (y[outside], x[outside]), (y[inside], x[inside])


def extent(shape: Shape, lens: Lens) -> Box:
    """What part of the picture a shape may cover."""
    edges = [edge for centre, radius in shape.balls() for edge in disc(centre, radius, lens)]
    if not edges or None in edges:
        return 0, 0, lens.width, lens.height
    x, y = zip(*filter(None, edges), strict=True)
    left, right = (round(min(max(each, 0), lens.width)) for each in (min(x) - MARGIN, max(x) + MARGIN))
    top, bottom = (round(min(max(each, 0), lens.height)) for each in (min(y) - MARGIN, max(y) + MARGIN))
    return left, top, right, bottom


def disc(centre: tuple[float, float, float], radius: float, lens: Lens) -> list[tuple[float, float] | None]:
    """Two opposite corners of a square around what a ball covers; None where it comes near the plane of the eye."""
    depth, middle = lens.depth(centre), lens.pixel(centre)
    if middle is None or depth <= 2 * radius:
        return [None]
    # The farther from the middle of the picture, the longer is what a ball covers: no more than by this.
    slant = hypot(*minus(centre, lens.eye)) / depth
    reach = lens.width / 2 / hypot(*lens.right) * radius / (depth - radius) * slant
    return [(middle[0] - reach, middle[1] - reach), (middle[0] + reach, middle[1] + reach)]


def hits(shape: Shape, lens: Lens, x: NDArray[np.int64], y: NDArray[np.int64]) -> Mask:
    """Whether the rays through the middles of pixels meet the shape."""
    kind = next(kind for kind in KINDS if kind.element is type(shape))
    across, down = (2 * x + 1) / lens.width - 1, 1 - (2 * y + 1) / lens.height
    right, up, forward = Vec(*lens.right), Vec(*lens.up), Vec(*lens.forward)
    with np.errstate(all="ignore"):
        direction = unit(across * right + down * up + forward)
        hit, _ = kind.intersect(shape.pack(), Vec(*map(np.float64, lens.eye)), direction)
    return np.broadcast_to(hit, x.shape)
