"""Light sources: point, spot and parallel lights, and their fading with distance."""

from __future__ import annotations

from math import inf
from typing import Any

from minirt.kernel.scene_arrays import has_rows
from minirt.lanes import Number, Vec, dot, inverse_root, maximum, minimum, splat, where


def incident_light(spots: Any, light: int, position: Vec, point: Vec) -> tuple[Vec, Number, Number]:
    """Return the direction from a point towards a light source, the source's distance, and its relative strength there.

    `spots` (m, 7) has for each light: the direction in which it shines; the cosine of the angle from there to the edge
    of a spot's cone; one over the further increase of the cosine up to where the spot has its full strength; one over
    the distance at which the light has faded to nothing (0: never); and 1 for parallel light. None or no rows: all
    lights shine in all directions and do not fade.
    """
    offset = position - point
    squared = dot(offset, offset)
    per_length = inverse_root(squared)
    to_light = offset * per_length
    distance = squared * per_length
    if spots is None or not has_rows(spots):
        return to_light, distance, splat(1.0, distance)
    axis = Vec(spots[light, 0], spots[light, 1], spots[light, 2])
    parallel = spots[light, 6] > 0.5
    to_light = where(parallel, -axis, to_light)
    distance = where(parallel, inf, distance)
    rim = clamp_to_unit((-dot(to_light, axis) - spots[light, 3]) * spots[light, 4])
    strength = where(parallel, 1.0, smoothstep(rim) * maximum(1.0 - distance * spots[light, 5], 0.0))
    return to_light, distance, strength


def clamp_to_unit(x: Number) -> Number:
    """Clamp a number to [0, 1]."""
    return minimum(maximum(x, 0.0), 1.0)


def smoothstep(x: Number) -> Number:
    """Hermite's cubic: from 0 at 0 to 1 at 1, with slope 0 at both ends."""
    return x * x * (3.0 - 2.0 * x)
