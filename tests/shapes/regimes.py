"""Regimes: random shapes and rays that are hard in one respect each. Lengths are in sizes of the shape."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.shapes import Shape
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.sphere import Sphere

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


def sphere(random: Random, size: float, offset: float) -> Sphere:
    centre = offset * random_directions(random) + size * random.normal(size=3)
    return Sphere(tuple(centre), size * random.uniform(0.5, 2), GREY)


def cylinder(random: Random, size: float, offset: float) -> Cylinder:
    centre = offset * random_directions(random) + size * random.normal(size=3)
    axis = tuple(random_directions(random).clip(-1, 1))
    return Cylinder(tuple(centre), axis, size * random.uniform(0.5, 2), size * random.uniform(0.5, 3), GREY)


Make = Callable[[Random, float, float], Shape]


def centre_of(shape: Shape) -> Array:
    return np.array(shape.centre)


def aimed(
    make: Make,
    seed: int,
    size: float = 1.0,
    far: tuple[float, float] = (3.0, 20.0),
    offset: float = 0.0,
    count: int = 25,
) -> Rays:
    """Rays from `far` sizes away at points in and around the shape: some hit and some miss, few near the edge."""
    random = np.random.default_rng(seed)
    shapes = [make(random, size, offset) for _ in range(count)]
    centres = np.stack([centre_of(shape) for shape in shapes])[:, None]
    origins = centres + size * log_uniform(random, *far, count, RAYS, 1) * random_directions(random, count, RAYS)
    targets = centres + size * random.uniform(-0.6, 0.6, (count, RAYS, 3))
    return Rays(shapes, origins, unit(targets - origins))


def just_above(seed: int, height: float, count: int = 25) -> Rays:
    """Rays from a height above a sphere of diameter 1e9, downwards at a slope of a tenth or more."""
    random = np.random.default_rng(seed)
    shapes = [Sphere(tuple(random_directions(random)), 1e9, GREY) for _ in range(count)]
    centres = np.stack([centre_of(shape) for shape in shapes])[:, None]
    up = random_directions(random, count, RAYS)
    origins = centres + (5e8 + height) * up
    aside = random_perpendiculars(random, up, count, RAYS)
    return Rays(shapes, origins, unit(aside - random.uniform(0.1, 10, (count, RAYS, 1)) * up))


def tangent_to_side(seed: int, count: int = 25) -> Rays:
    """Rays past the side of a cylinder, 1e-16 to 1e-4 inside or outside."""
    random = np.random.default_rng(seed)
    shapes = [cylinder(random, 1.0, 0.0) for _ in range(count)]
    origins, directions = np.empty((2, count, RAYS, 3))
    for i, shape in enumerate(shapes):
        axis = np.array(shape.axis)
        aside = random_perpendiculars(random, axis, RAYS)
        sign = random.choice([-1.0, 1.0], (RAYS, 1))
        touch = centre_of(shape) + shape.height * random.uniform(-0.4, 0.4, (RAYS, 1)) * axis
        touch = touch + shape.diameter / 2 * (1 + sign * log_uniform(random, 1e-16, 1e-4, RAYS, 1)) * aside
        directions[i] = unit(np.cross(aside, axis) + random.uniform(-1, 1, (RAYS, 1)) * axis)
        origins[i] = touch - random.uniform(3, 20, (RAYS, 1)) * directions[i]
    return Rays(shapes, origins, directions)


def rim(seed: int, count: int = 25) -> Rays:
    """Rays from everywhere at the edge between cap and side, 1e-16 to 1e-6 beside it."""
    random = np.random.default_rng(seed)
    shapes = [cylinder(random, 1.0, 0.0) for _ in range(count)]
    origins, directions = np.empty((2, count, RAYS, 3))
    for i, shape in enumerate(shapes):
        axis = np.array(shape.axis)
        edge = (
            centre_of(shape) + shape.height / 2 * axis + shape.diameter / 2 * random_perpendiculars(random, axis, RAYS)
        )
        edge = edge + log_uniform(random, 1e-16, 1e-6, RAYS, 1) * random_directions(random, RAYS)
        directions[i] = random_directions(random, RAYS)
        origins[i] = edge - random.uniform(3, 20, (RAYS, 1)) * directions[i]
    return Rays(shapes, origins, directions)


def along_axis(seed: int, off: tuple[float, float] | None, offset: float = 0.0, count: int = 25) -> Rays:
    """Rays along the axis of a cylinder, or off it by an angle (radians) in `off`, at its cap and beside it."""
    random = np.random.default_rng(seed)
    shapes = [cylinder(random, 1.0, offset) for _ in range(count)]
    origins, directions = np.empty((2, count, RAYS, 3))
    for i, shape in enumerate(shapes):
        axis = np.array(shape.axis)
        angle = log_uniform(random, *off, RAYS, 1) if off else np.zeros((RAYS, 1))
        start = shape.diameter / 2 * random.choice([0.0, 0.5, 0.9, 1.1], (RAYS, 1))
        directions[i] = axis if off is None else unit(axis + angle * random_perpendiculars(random, axis, RAYS))
        origins[i] = centre_of(shape) - 5 * axis + start * random_perpendiculars(random, axis, RAYS)
    return Rays(shapes, origins, directions)


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


def disc(seed: int, height: float = 1e-9, count: int = 25) -> Rays:
    """Rays at a cylinder that is nearly flat."""
    rays = aimed(cylinder, seed, count=count)
    return rays._replace(shapes=[shape.replace(height=height) for shape in rays.shapes])
