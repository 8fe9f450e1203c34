"""The size of a vector for bounds of rounding."""

from __future__ import annotations

from minirt.lanes.vec import Number, Vec
from minirt.lanes.verbs import fabs, maximum


def largest(v: Vec) -> Number:
    """The largest coordinate, without its sign."""
    return maximum(maximum(fabs(v.x), fabs(v.y)), fabs(v.z))
