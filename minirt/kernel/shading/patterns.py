"""Solid textures: marble, wood and clouds in the frame of a shape (Perlin, An Image Synthesizer, 1985).

A pattern gives each point of space a share from 0 to 1. By this share a second colour replaces that of the surface, and
the surface is raised, as a bump map raises it. A texture of space needs no coordinates on the surface: it has no seam.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.kernel.scene_arrays import has_rows
from minirt.kernel.shading.fractal_noise import fractal_noise
from minirt.kernel.shading.pattern_shares import CLOUD_NOISE, MARBLE_NOISE, WOOD_NOISE, clouds, marble, wood
from minirt.lanes import Number, Vec, dot, fabs, maximum, sqrt, unit

MARBLE, WOOD, CLOUDS = 0, 1, 2  # kinds of patterns
KIND, COLOUR, OCTAVES, PER_SIZE, ORIGIN, FRAME = 0, 1, 4, 5, 6, 9  # columns of `Patterns.rows`
COLUMNS = 18
FLATTEST = 2.0**-10  # least cosine between a ray and a normal for the footprint of a pixel


class Patterns(NamedTuple):
    """The patterns of n shapes, k in all."""

    ranges: Any  # (n, 2) the patterns of a shape: its first row, and the row behind its last
    rows: Any  # (k, 18) kind, second colour, number of octaves, 1 / size, origin and three axes of the shape's frame
    heights: Any  # (k,) height of the second colour above the first, in scene units; None, or no rows, if all are 0


def apply_patterns(
    patterns: Any, index: int, point: Vec, footprint: Number, normal: Vec, colour: Vec
) -> tuple[Vec, Vec]:
    """Apply the patterns of shape `index`, one after the other, to its shading normals and colours at some points.

    `footprint` is the width of a pixel on the surface.
    """
    if has_rows(patterns.ranges):
        for i in range(patterns.ranges[index, 0], patterns.ranges[index, 1]):
            row = patterns.rows[i]
            second = Vec(row[COLOUR], row[COLOUR + 1], row[COLOUR + 2])
            share, gradient = pattern_at(row, point, footprint)
            colour = colour + share * (second - colour)
            if patterns.heights is not None and has_rows(patterns.heights):
                normal = raised(normal, patterns.heights[i] * gradient)
    return normal, colour


def raised(normal: Vec, gradient: Vec) -> Vec:
    """Return the normal of a surface that is raised by a height with this gradient in space.

    Only the part of the gradient along the surface tilts it (Mikkelsen, Simulation of Wrinkled Surfaces Revisited,
    2008).
    """
    return unit(normal - (gradient - dot(gradient, normal) * normal))


def pixel_footprint(camera: Any, point: Vec, t: Number, direction: Vec, normal: Vec) -> Number:
    """Return the width of a pixel on a surface that a ray meets after the distance t: of a square of the same area.

    The way of a ray that was mirrored is not known, but it is at least the distance of the point from the eye.
    """
    offset = point - Vec(camera[0], camera[1], camera[2])
    squared = maximum(t * t, dot(offset, offset)) / maximum(fabs(dot(normal, direction)), FLATTEST)
    right = Vec(camera[6], camera[7], camera[8])
    return sqrt(squared * dot(right, right))


def pattern_at(row: Any, point: Vec, footprint: Number) -> tuple[Number, Vec]:
    """Return the share of a pattern at some points, and its gradient; `footprint` is the width of a pixel there."""
    per_size = row[PER_SIZE]
    x = Vec(row[FRAME], row[FRAME + 1], row[FRAME + 2])
    y = Vec(row[FRAME + 3], row[FRAME + 4], row[FRAME + 5])
    z = Vec(row[FRAME + 6], row[FRAME + 7], row[FRAME + 8])
    offset = per_size * (point - Vec(row[ORIGIN], row[ORIGIN + 1], row[ORIGIN + 2]))
    p = Vec(dot(offset, x), dot(offset, y), dot(offset, z))
    share, slope = share_and_slope(row[KIND], int(row[OCTAVES]), p, per_size * footprint)
    return share, per_size * (slope.x * x + slope.y * y + slope.z * z)


def share_and_slope(kind: float, octaves: int, p: Vec, footprint: Number) -> tuple[Number, Vec]:
    """Return the share at p, in the frame of the shape and in sizes of the pattern, and its gradient there."""
    if kind == MARBLE:
        frequency, stretch, fold = MARBLE_NOISE
    elif kind == WOOD:
        frequency, stretch, fold = WOOD_NOISE
    else:
        frequency, stretch, fold = CLOUD_NOISE
    fractal = fractal_noise(p, footprint, octaves, frequency, stretch, fold)
    if kind == MARBLE:
        return marble(p, fractal, footprint)
    if kind == WOOD:
        return wood(p, fractal, footprint)
    return clouds(fractal)
