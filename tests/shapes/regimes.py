"""Random rays and directions."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.shapes import Shape

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
