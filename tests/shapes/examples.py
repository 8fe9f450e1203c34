"""Random shapes of any kind, made from its declared fields; random rays at them, and their hits."""

from __future__ import annotations

from contextlib import suppress
from typing import NamedTuple

import numpy as np

from minirt.element import fields_of
from minirt.errors import ElementError
from minirt.fields import Colour, Direction, Field, Length, Lengths, Point
from minirt.kernel.trace import ROUNDING
from minirt.rendering.packing.packed_shapes import bounding_boxes
from minirt.shapes import Kind, Shape
from tests.shapes.execution_modes import compiled, surfaces
from tests.shapes.regimes import Array, Random, log_uniform, random_directions, unit


def random_value(field: Field, random: Random, size: float, middle: Array) -> object:
    """A random value of a field, for a shape of about this size near a point."""
    if isinstance(field, Point):
        return tuple(middle + size * random.normal(size=3))
    if isinstance(field, Direction):
        return tuple(random_directions(random).clip(-1, 1))
    if isinstance(field, Length):
        return size * log_uniform(random, 0.2, 5)
    if isinstance(field, Lengths):
        return tuple(size * log_uniform(random, 0.2, 5, 3))
    assert isinstance(field, Colour)
    return tuple(random.integers(0, 256, 3))


def example(kind: Kind, random: Random, size: float = 1.0, offset: float = 0.0) -> Shape:
    """A random shape of a kind, of about this size and at this distance from the origin."""
    middle = offset * random_directions(random)
    placed = [each for each in fields_of(kind.element) if not each.keyed]
    while True:
        with suppress(ElementError):  # fields that contradict each other
            return kind.element(**{each.name: random_value(each, random, size, middle) for each in placed})


def place(shape: Shape) -> Array:
    """The middle of a shape, or a point of an infinite one."""
    balls = shape.balls()
    if balls:
        return np.mean([centre for centre, _ in balls], axis=0)
    return np.array(next(getattr(shape, each.name) for each in fields_of(type(shape)) if isinstance(each, Point)))


def scaled(shape: Shape, factor: float) -> Shape:
    """A shape that is larger by a factor, as seen from the origin: each number is rounded once."""
    new = {}
    for field in fields_of(type(shape)):
        value = getattr(shape, field.name)
        if isinstance(field, Length):
            new[field.name] = factor * value
        elif isinstance(field, Point | Lengths):
            new[field.name] = tuple(factor * part for part in value)
    return shape.replace(**new)


class Hits(NamedTuple):
    """Hits of random rays: m shapes, n rays for each."""

    shapes: list[Shape]
    points: Array  # (m, n, 3) on the surface
    normals: Array  # (m, n, 3) outward where there is an outside
    facing: Array  # (m, n, 3) the normals, turned towards the eye
    hit: Array  # (m, n) whether the ray hit at all


def hits(kind: Kind, seed: int, size: float, offset: float, shapes: int = 100, rays: int = 128) -> Hits:
    """Hits of rays from random points, up to ten sizes away, at random shapes."""
    random = np.random.default_rng(seed)
    made = [example(kind, random, size, offset) for _ in range(shapes)]
    middles = np.stack([place(shape) for shape in made])[:, None]
    origins = middles + size * log_uniform(random, 0.1, 10, shapes, rays, 1) * random_directions(random, shapes, rays)
    directions = unit(middles + size * random.uniform(-0.6, 0.6, (shapes, rays, 3)) - origins)
    t = compiled(made, origins, directions)
    hit = np.isfinite(t)
    points, normals = surfaces(made, origins + np.where(hit, t, 1.0)[..., None] * directions)
    away = np.sum(normals * directions, axis=-1, keepdims=True) > 0
    return Hits(made, points, normals, np.where(away, -normals, normals), hit)


def shadow_offsets(points: Array, shapes: list[Shape]) -> Array:
    """The offset from the surface at which `minirt.kernel.shading.shade` starts shadow rays, (m, n, 1)."""
    extents = np.array([np.abs(bounding_boxes([shape])).max() for shape in shapes])[:, None]
    return (ROUNDING * 2.0**-53 * (np.abs(points).max(axis=-1) + extents))[..., None]
