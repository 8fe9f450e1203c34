"""Rectangle of a larger picture, rendered without the rest: its rays and its samples are those of the whole picture.

A rectangle that is rendered begins at the corner of a tile, so that its tiles and packets are those of the whole
picture. A region anywhere else is cut out of the rectangle that begins with its first tile.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple, TypeAlias

from minirt.errors import RenderError
from minirt.kernel.pixels import TILE

Region: TypeAlias = tuple[int, int, int, int]  # x, y, width and height, in pixels


class Crop(NamedTuple):
    """Place of a rendered rectangle in its picture. The size of the rectangle is that of the pixels to render into."""

    width: int  # of the whole picture, in pixels
    height: int
    left: int = 0  # column and row of the picture at which the rectangle begins: multiples of `TILE`
    top: int = 0


class Cut(NamedTuple):
    """The rectangle to render for a region, and what to keep of it."""

    crop: Crop
    shape: tuple[int, int]  # rows and columns of the rectangle
    kept: tuple[slice, slice]  # those of the region


def cut_for(region: Region | None, width: int, height: int) -> Cut:
    """Return what to render for a region (x, y, width, height) of a picture, or for all of it; RenderError for a region
    that does not lie in the picture."""
    if region is None:
        return Cut(Crop(width, height), (height, width), (slice(None), slice(None)))
    x, y, across, down = region
    if across < 1 or down < 1:
        raise RenderError(f"a region has at least 1x1 pixels, got {across}x{down}")
    if x < 0 or y < 0 or x + across > width or y + down > height:
        raise RenderError(f"region {x},{y},{across},{down} does not lie in the picture of {width}x{height} pixels")
    beside, above = x % TILE, y % TILE
    crop = Crop(width, height, x - beside, y - above)
    return Cut(crop, (above + down, beside + across), (slice(above, None), slice(beside, None)))


def strips_of(region: Region, samples: int, rays: int) -> list[Region]:
    """Divide a region of a picture into strips of about so many rays, one beside the other, that begin with tiles."""
    x, y, width, height = region
    step = max(rays // (height * samples) // TILE, 1) * TILE
    edges = [x, *range(x // TILE * TILE + step, x + width, step), x + width]
    return [(left, y, right - left, height) for left, right in pairwise(edges)]
