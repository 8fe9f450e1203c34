"""Rays aimed at hard points of shapes, or along hard directions."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from minirt.shapes import Shape
from tests.shapes.examples import place
from tests.shapes.regimes import RAYS, Array, Random, Rays, log_uniform, random_directions, random_perpendiculars, unit
from tests.stability.common import COUNT

Make = Callable[[Random], Shape]
Spot = Callable[[Random, Shape], Array]  # (RAYS, 3): points of a shape, or directions


def at(seed: int, make: Make, spot: Spot, off: tuple[float, float] = (1e-16, 1e-6), count: int = COUNT) -> Rays:
    """Rays from everywhere at points of shapes, missing them by a distance in `off`."""
    random = np.random.default_rng(seed)
    shapes, origins, directions = [], *np.empty((2, count, RAYS, 3))
    for i in range(count):
        shape = make(random)
        target = spot(random, shape) + log_uniform(random, *off, RAYS, 1) * random_directions(random, RAYS)
        directions[i] = random_directions(random, RAYS)
        origins[i] = target - random.uniform(3, 20, (RAYS, 1)) * directions[i]
        shapes.append(shape)
    return Rays(shapes, origins, directions)


def along(seed: int, make: Make, way: Spot, off: tuple[float, float] | None = None, offset: float = 0.0) -> Rays:
    """Rays along directions, or off them by an angle (radians) in `off`, at points in and around shapes."""
    random = np.random.default_rng(seed)
    shapes, origins, directions = [], *np.empty((2, COUNT, RAYS, 3))
    for i in range(COUNT):
        shape = make(random)
        shape = shape.replace(**{points(shape)[0]: tuple(offset * random_directions(random))}) if offset else shape
        exact = way(random, shape)
        angle = log_uniform(random, *off, RAYS, 1) if off else 0.0
        directions[i] = unit(exact + angle * random_directions(random, RAYS))
        origins[i] = place(shape) + random.uniform(-0.6, 0.6, (RAYS, 3)) - random.uniform(0, 9, (RAYS, 1)) * exact
        shapes.append(shape)
    return Rays(shapes, origins, directions)


def points(shape: Shape) -> list[str]:
    return [name for name in ("centre", "apex", "vertex") if hasattr(shape, name)]


def axis_of(shape: Shape) -> Array:
    return np.array(shape.axis)


def edge(middle: Array, shape: Shape, radius: float, random: Random) -> Array:
    """Random points of a circle about a point of the axis of a shape."""
    return middle + radius * random_perpendiculars(random, axis_of(shape), RAYS)
