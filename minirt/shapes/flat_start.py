"""Rays that meet the plane of a flat shape, and those that start on it, for all that rounding lets one know, and so do
not hit it there."""

from __future__ import annotations

from minirt.lanes import Mask, Number, Vec, dot, fabs, max_norm, unit_roundoff, where
from minirt.shapes.plane import PARALLEL

CLOSE = 2.0**-20  # shares of the size of a shape: a hit nearer than that may be the place where the ray starts
ROUNDINGS = 4.0


def start_error(origin: Vec, f: Vec) -> Number:
    """Distance to a flat surface below which a ray starts on it.

    The roundings of the origin's coordinates, and of its height, which is computed from f, its difference from the
    shape's centre.
    """
    return ROUNDINGS * unit_roundoff(f.x) * (max_norm(origin) + (fabs(f.x) + fabs(f.y) + fabs(f.z)))


def least_t(origin: Vec, f: Vec, height: Number, size: float) -> Number:
    """The t that a hit must exceed: not 0 for rays that start on the surface, so that they do not hit it there.

    `height` is that of the origin above the surface, and `size` that of the shape.
    """
    return where(fabs(height) <= start_error(origin, f), CLOSE * size, 0.0)


def crossing(normal: Vec, f: Vec, height: Number, direction: Vec, least: Number) -> tuple[Mask, Number, Vec]:
    """Whether and where a ray meets the plane of a flat shape at a t of more than the `least`: t and the point.

    The ray starts at f and at this `height`, relative to the centre, as the point is.
    """
    slope = dot(normal, direction)
    t = -height / slope
    return (fabs(slope) > PARALLEL * unit_roundoff(slope)) & (t > least), t, f + t * direction
