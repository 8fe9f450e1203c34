"""Rays snapped onto the special places of a shape: exactly, and by one to four units in the last place off them.

Two places are combined for each ray: it starts on one of them, or runs through it, towards a point of the other or
along the other's directions.
"""

from __future__ import annotations

import numpy as np

from minirt.shapes import Shape
from tests.shapes.regimes import Array, Random, random_directions, unit
from tests.stability.places import places
from tests.stability.regime import U, size

TINY = (0.0, 5e-324, 1e-310, 1e-300, 1e-20)  # components of directions that take the place of a 0


def snapped(shape: Shape, random: Random, n: int) -> tuple[Array, Array]:
    """Origins and unit directions of n rays, (n, 3) each."""
    special, around = places(shape), size(shape) or 1.0
    one, other = random.integers(len(special), size=(2, n))
    a, b = (chosen(which, [place.points(random, n) for place in special]) for which in (one, other))
    in_one = chosen(one, [place.ways(random, a) for place in special])
    in_other = chosen(other, [place.ways(random, b) for place in special])
    ways = [b - a, b - a, in_one, in_other, in_other, random_directions(random, n)]
    direction = chosen(random.integers(len(ways), size=n), ways)
    direction = np.where(np.isfinite(direction).all(axis=-1, keepdims=True), direction, 0.0)
    direction[~direction.any(axis=-1)] = 1.0, 0.0, 0.0
    direction = tilted(random, unit(direction))
    share = np.where(random.random((n, 1)) < 0.5, 2.0 ** random.integers(-3, 7, (n, 1)), 9 * random.random((n, 1)))
    origin = np.where(random.random((n, 1)) < 0.6, a, a - around * share * direction)
    return nudged(random, origin, around), direction


def chosen(which: Array, points: list[Array]) -> Array:
    """One of several (n, 3) for each ray."""
    found: Array = np.stack(points)[which, np.arange(len(which))]
    return found


def nudged(random: Random, points: Array, around: float) -> Array:
    """Half of the points by up to four units in the last place off, in some coordinates."""
    ulp = np.where(points == 0, U * around, np.spacing(np.abs(points)))
    return points + ulp * some_units(random, points)


def tilted(random: Random, directions: Array) -> Array:
    """Half of the directions by up to four units in the last place off, in some components; zeros of both signs."""
    tiny = np.where(random.random(directions.shape) < 0.5, U, random.choice(TINY, directions.shape))
    ulp = np.where(directions == 0, tiny, np.spacing(np.abs(directions)))
    tilt = directions + ulp * some_units(random, directions)
    return np.where(tilt == 0, random.choice([-1.0, 1.0], tilt.shape) * 0.0, unit(tilt))


def some_units(random: Random, points: Array) -> Array:
    units = random.integers(-4, 5, points.shape) * (random.random(points.shape) < 0.6)
    return np.where(random.random((len(points), 1)) < 0.5, units, 0)
