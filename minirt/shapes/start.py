"""Rays that start on a flat surface, to rounding, and so do not hit it there."""

from __future__ import annotations

from minirt.lanes import Vec, fabs, unit_roundoff
from minirt.lanes.operations import Mask
from minirt.lanes.vec import Number

CLOSE = 2.0**-40  # shares of the size of a shape: a hit nearer than that may be the place where the ray starts
ROUNDINGS = 4  # of a scalar product of a unit vector and a difference


def is_rounding(height: Number, normal: Vec, f: Vec) -> Mask:
    """Whether a `height`, the scalar product of `normal` and `f`, is 0 for all that rounding lets one know."""
    terms = fabs(normal.x * f.x) + fabs(normal.y * f.y) + fabs(normal.z * f.z)
    return fabs(height) <= ROUNDINGS * unit_roundoff(terms) * terms


def coordinate_error(f: Vec) -> Number:
    """Bound of the rounding error of the coordinates of f, the difference of two points, in a frame that is rounded
    itself."""
    return ROUNDINGS * unit_roundoff(f.x) * (fabs(f.x) + fabs(f.y) + fabs(f.z))
