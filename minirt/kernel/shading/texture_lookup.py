"""Bilinear texture lookup with repeat addressing, one sample per SIMD lane."""

from __future__ import annotations

from typing import Any

from minirt.lanes import Number, Vec, floor, gather, maximum, minimum


def texture_lookup(texels: Any, pictures: Any, which: int, u: Number, v: Number) -> Vec:
    """Look up the colour of picture number `which` at u, v: from 0 to 1 from left to right and from bottom to top.

    `texels` holds the pixels of all pictures; `pictures` has for each its first texel, width, height and channels. The
    four pixels around a place are interpolated linearly, by its distances from their centres.
    """
    red = channel_lookup(texels, pictures, which, 0, u, v)
    green = channel_lookup(texels, pictures, which, 1, u, v)
    blue = channel_lookup(texels, pictures, which, 2, u, v)
    return Vec(red, green, blue)


def channel_lookup(texels: Any, pictures: Any, which: int, channel: int, u: Number, v: Number) -> Number:
    """Look up one channel of a picture at u, v, interpolated like `texture_lookup`."""
    base, columns, rows, step = (
        pictures[which, 0] + channel,
        pictures[which, 1],
        pictures[which, 2],
        pictures[which, 3],
    )
    x = u * columns - 0.5
    y = (1.0 - v) * rows - 0.5
    left, top = floor(x), floor(y)
    across, down = minimum(x - left, 1.0), minimum(y - top, 1.0)  # no NaN, as in `wrap`
    x0, x1 = wrap(left, columns), wrap(left + 1.0, columns)
    y0, y1 = wrap(top, rows) * columns, wrap(top + 1.0, rows) * columns
    upper = lerp(gather(texels, base + step * (y0 + x0)), gather(texels, base + step * (y0 + x1)), across)
    lower = lerp(gather(texels, base + step * (y1 + x0)), gather(texels, base + step * (y1 + x1)), across)
    return lerp(upper, lower, down)


def wrap(index: Number, size: float) -> Number:
    """Wrap the index of a pixel, a whole number, to [0, size); 0 for NaN, which rays that hit nothing have."""
    return minimum(maximum(index - size * floor(index / size), 0.0), size - 1.0)


def lerp(a: Number, b: Number, share: Number) -> Number:
    """Linear interpolation from a at share 0 to b at share 1."""
    return a + share * (b - a)


def height_gradient(texels: Any, pictures: Any, which: int, u: Number, v: Number) -> tuple[Number, Number]:
    """Gradient of a height map, a picture's first channel, along u and v: central differences over a pixel."""
    columns, rows = pictures[which, 1], pictures[which, 2]
    right = channel_lookup(texels, pictures, which, 0, u + 0.5 / columns, v)
    left = channel_lookup(texels, pictures, which, 0, u - 0.5 / columns, v)
    above = channel_lookup(texels, pictures, which, 0, u, v + 0.5 / rows)
    below = channel_lookup(texels, pictures, which, 0, u, v - 0.5 / rows)
    return (right - left) * columns, (above - below) * rows
