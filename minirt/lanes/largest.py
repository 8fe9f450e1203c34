"""Maximum norm of a vector, for bounds of rounding errors."""

from __future__ import annotations

from minirt.lanes.operations import fabs, maximum
from minirt.lanes.vec import Number, Vec


def largest(v: Vec) -> Number:
    """Return the largest absolute value of a coordinate."""
    return maximum(maximum(fabs(v.x), fabs(v.y)), fabs(v.z))
