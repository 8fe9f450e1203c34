"""Pictures on lanes: looked up between the centres of their pixels, and repeated beyond their edges."""

from __future__ import annotations

from typing import Any

from minirt.lanes import Vec, floor, gather, maximum, minimum
from minirt.lanes.vec import Number


def texture_lookup(texels: Any, pictures: Any, which: int, u: Number, v: Number) -> Vec:
    """The colour of a picture at u, v, which run from 0 to 1 from left to right and from the bottom to the top.

    The pixels are `texels`; `pictures` has for each picture where it begins, its width, height and channels. Bilinear:
    each of the four pixels around a place counts as much as the place is near to its centre.
    """
    red = channel_lookup(texels, pictures, which, 0, u, v)
    green = channel_lookup(texels, pictures, which, 1, u, v)
    blue = channel_lookup(texels, pictures, which, 2, u, v)
    return Vec(red, green, blue)


def channel_lookup(texels: Any, pictures: Any, which: int, channel: int, u: Number, v: Number) -> Number:
    """One of the three numbers of that colour."""
    start, wide, high, step = pictures[which, 0] + channel, pictures[which, 1], pictures[which, 2], pictures[which, 3]
    x = u * wide - 0.5
    y = (1.0 - v) * high - 0.5
    left, top = floor(x), floor(y)
    across, down = minimum(x - left, 1.0), minimum(y - top, 1.0)  # no NaN, as in `wrap`
    x0, x1 = wrap(left, wide), wrap(left + 1.0, wide)
    y0, y1 = wrap(top, high) * wide, wrap(top + 1.0, high) * wide
    upper = lerp(gather(texels, start + step * (y0 + x0)), gather(texels, start + step * (y0 + x1)), across)
    lower = lerp(gather(texels, start + step * (y1 + x0)), gather(texels, start + step * (y1 + x1)), across)
    return lerp(upper, lower, down)


def wrap(place: Number, size: float) -> Number:
    """A whole number brought into [0, size) by steps of `size`; 0 for NaN, which rays have that hit nothing."""
    return minimum(maximum(place - size * floor(place / size), 0.0), size - 1.0)


def lerp(a: Number, b: Number, share: Number) -> Number:
    """a, and as much of b instead as the share says."""
    return a + share * (b - a)


def height_gradient(texels: Any, pictures: Any, which: int, u: Number, v: Number) -> tuple[Number, Number]:
    """How fast the first channel of a picture rises along u and along v: central differences over a pixel."""
    wide, high = pictures[which, 1], pictures[which, 2]
    right = channel_lookup(texels, pictures, which, 0, u + 0.5 / wide, v)
    left = channel_lookup(texels, pictures, which, 0, u - 0.5 / wide, v)
    above = channel_lookup(texels, pictures, which, 0, u, v + 0.5 / high)
    below = channel_lookup(texels, pictures, which, 0, u, v - 0.5 / high)
    return (right - left) * wide, (above - below) * high
