"""How light comes from a lamp: from a point, in a cone, or parallel."""

from __future__ import annotations

from math import inf
from typing import Any

from minirt.lanes import Vec, dot, inverse_root, maximum, minimum, splat, where
from minirt.lanes.vec import Number


def incident_light(beams: Any, lamp: int, place: Vec, start: Vec) -> tuple[Vec, Number, Number]:
    """Seen from a point, the direction towards a lamp at `place`, its distance and how strong its light is.

    `beams` (m, 7) has for each lamp the direction in which it shines, the cosine of the angle to that at which a spot
    ends, one over by how much the cosine is greater where the spot has its full light, one over the distance at which
    the light is gone (0: never), and 1 for parallel light; None where all shine everywhere, as strong at any distance.
    """
    way = place - start
    squared = dot(way, way)
    per_length = inverse_root(squared)
    towards = way * per_length
    distance = squared * per_length
    if beams is None:
        return towards, distance, splat(1.0, distance)
    axis = Vec(beams[lamp, 0], beams[lamp, 1], beams[lamp, 2])
    parallel = beams[lamp, 6] > 0.5
    towards = where(parallel, -axis, towards)
    distance = where(parallel, inf, distance)
    inner = clamp_to_unit((-dot(towards, axis) - beams[lamp, 3]) * beams[lamp, 4])
    strength = where(parallel, 1.0, smoothstep(inner) * maximum(1.0 - distance * beams[lamp, 5], 0.0))
    return towards, distance, strength


def clamp_to_unit(x: Number) -> Number:
    """The nearest number in [0, 1]."""
    return minimum(maximum(x, 0.0), 1.0)


def smoothstep(x: Number) -> Number:
    """From 0 at 0 to 1 at 1 without a corner: Hermite's cubic."""
    return x * x * (3.0 - 2.0 * x)
