"""The size of a vector for bounds of rounding."""

from __future__ import annotations

from minirt.lanes.operations import fabs, maximum
from minirt.lanes.vec import Number, Vec


def largest(v: Vec) -> Number:
    """The largest coordinate, without its sign."""
    return maximum(maximum(fabs(v.x), fabs(v.y)), fabs(v.z))
