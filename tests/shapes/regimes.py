"""Random rays at shapes, among them rays within tubes, and random directions. Lengths are in sizes of the shape."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.shapes import Shape
from minirt.shapes.cylinder import Cylinder

Array = NDArray[np.float64]
Random = np.random.Generator
GREY = (128, 128, 128)
RAYS = 16  # for each shape: a packet


class Rays(NamedTuple):
    """m shapes, and n rays for each of them."""

    shapes: list[Shape]
    origins: Array  # (m, n, 3)
    directions: Array  # (m, n, 3), unit


def unit(v: Array) -> Array:
    v = v / np.abs(v).max(axis=-1, keepdims=True)
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def random_directions(random: Random, *shape: int) -> Array:
    """Random unit vectors."""
    return unit(random.normal(size=(*shape, 3)))


def random_perpendiculars(random: Random, axis: Array, *shape: int) -> Array:
    """Random unit vectors perpendicular to `axis`."""
    v = np.cross(random_directions(random, *shape), axis)
    return unit(v)


def log_uniform(random: Random, low: float, high: float, *shape: int) -> Array:
    """Random numbers with uniform logarithms."""
    return np.exp(random.uniform(np.log(low), np.log(high), shape))


def cylinder(random: Random, size: float, offset: float) -> Cylinder:
    centre = offset * random_directions(random) + size * random.normal(size=3)
    axis = tuple(random_directions(random).clip(-1, 1))
    return Cylinder(tuple(centre), axis, size * random.uniform(0.5, 2), size * random.uniform(0.5, 3), GREY)


def centre_of(shape: Shape) -> Array:
    return np.array(shape.centre)


def inside_tube(seed: int, height: float = 1e9, count: int = 25) -> Rays:
    """Rays from the middle of a very long cylinder, 1e-8 to 1e-2 radians off its axis."""
    random = np.random.default_rng(seed)
    shapes, origins, directions = [], *np.empty((2, count, RAYS, 3))
    for i in range(count):
        shape = cylinder(random, 1.0, 0.0).replace(height=height)
        axis = np.array(shape.axis)
        start = 0.4 * shape.diameter * random.uniform(-1, 1, (RAYS, 1)) * random_perpendiculars(random, axis, RAYS)
        origins[i] = centre_of(shape) + start
        directions[i] = unit(
            axis + log_uniform(random, 1e-8, 1e-2, RAYS, 1) * random_perpendiculars(random, axis, RAYS)
        )
        shapes.append(shape)
    return Rays(shapes, origins, directions)


def from_the_wall(seed: int, count: int = 25) -> Rays:
    """Rays across a long cylinder from just inside its side: the closest approach to the centre is 1e-13 to 1e-6 off
    it."""
    random = np.random.default_rng(seed)
    shapes, origins, directions = [], *np.empty((2, count, RAYS, 3))
    for i in range(count):
        shape = cylinder(random, 1.0, 0.0).replace(height=100.0)
        axis, radius = np.array(shape.axis), shape.diameter / 2
        out = random_perpendiculars(random, axis, RAYS)
        tilt = random.uniform(0.3, 1.2, (RAYS, 1))
        directions[i] = unit(np.sin(tilt) * axis - np.cos(tilt) * out)
        near = radius * (1 - log_uniform(random, 1e-13, 1e-6, RAYS, 1))
        wall = centre_of(shape) + near * (out + np.cos(tilt) / np.sin(tilt) * axis)
        origins[i] = wall + random.uniform(0.01, 0.1, (RAYS, 1)) * directions[i]
        shapes.append(shape)
    return Rays(shapes, origins, directions)
