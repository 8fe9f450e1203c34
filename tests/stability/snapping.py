"""Rays snapped onto the special places of a shape: exactly, and by one to four units in the last place off them.

Two places are combined for each ray: it starts on one of them, or runs through it, towards a point of the other or along
the other's directions.
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
    special = places(shape)
    sample = np.stack([place.points(random, n) for place in special])
    one, other = random.integers(len(special), size=(2, n))
    rays = np.arange(n)
    a, b = sample[one, rays], np.stack([place.points(random, n) for place in special])[other, rays]
    in_one = np.stack([place.ways(random, a) for place in special])[one, rays]
    in_other = np.stack([place.ways(random, b) for place in special])[other, rays]
    way = random.integers(6, size=(n, 1))
    direction = np.choose(way, [b - a, b - a, in_one, in_other, in_other, random_directions(random, n)])
    direction = np.where(np.isfinite(direction).all(axis=-1, keepdims=True), direction, 0.0)
    direction[~direction.any(axis=-1)] = 1.0, 0.0, 0.0
    direction = tilted(random, unit(direction))
    back = (size(shape) or 1.0) * np.where(random.random((n, 1)) < 0.5, 2.0 ** random.integers(-3, 7, (n, 1)), 9 * random.random((n, 1)))
    starts_there = random.random((n, 1)) < 0.6
    origin = np.where(starts_there, a, a - back * direction)
    return nudged(random, origin, size(shape) or 1.0), direction


def nudged(random: Random, points: Array, around: float) -> Array:
    """Half of the points by up to four units in the last place off, in some coordinates."""
    ulp = np.where(points == 0, U * around, np.spacing(np.abs(points)))
    return points + ulp * some_units(random, points)


def tilted(random: Random, directions: Array) -> Array:
    """Half of the directions by up to four units in the last place off, in some components; zeros of both signs."""
    near_zero = np.where(directions == 0, np.where(random.random(directions.shape) < 0.5, U, random.choice(TINY, directions.shape)), 0.0)
    ulp = np.where(directions == 0, near_zero, np.spacing(np.abs(directions)))
    tilt = directions + ulp * some_units(random, directions)
    return np.where(tilt == 0, random.choice([-1.0, 1.0], tilt.shape) * 0.0, unit(tilt))


def some_units(random: Random, points: Array) -> Array:
    units = random.integers(-4, 5, points.shape) * (random.random(points.shape) < 0.6)
    return np.where(random.random((len(points), 1)) < 0.5, units, 0)
