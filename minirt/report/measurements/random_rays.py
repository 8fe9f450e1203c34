"""Rays at shapes, at random: how they are placed. Lengths are in units of the size of the shape."""

from __future__ import annotations

from contextlib import suppress
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.element import fields_of
from minirt.fields import Colour, Direction, Field, Length, Lengths, Point, Real
from minirt.lanes import Vec
from minirt.rendering.packing.primitives import defining_points
from minirt.shapes import Kind, Shape

Array = NDArray[np.float64]
Random = np.random.Generator
GREY = (128, 128, 128)


class Rays(NamedTuple):
    """m shapes of a kind, and n rays for each of them."""

    shapes: list[Shape]
    origins: Array  # (m, n, 3)
    directions: Array  # (m, n, 3), unit


class Scale(NamedTuple):
    """How large shapes are, in scene units, and how far from the origin of the scene."""

    size: float = 1.0
    offset: float = 0.0
    lengths: tuple[tuple[str, float], ...] = ()  # fields that have a certain value


def unit(v: Array) -> Array:
    """Vectors of any length, scaled to length 1."""
    scaled: Array = v / np.abs(v).max(axis=-1, keepdims=True)
    scaled /= np.linalg.norm(scaled, axis=-1, keepdims=True)
    return scaled


def ways(random: Random, *shape: int) -> Array:
    """Random directions."""
    return unit(random.normal(size=(*shape, 3)))


def aside(random: Random, axes: Array) -> Array:
    """For each axis a random direction perpendicular to it."""
    return unit(np.cross(ways(random, *axes.shape[:-1]), axes))


def log(random: Random, low: float, high: float, *shape: int) -> Array:
    """Random numbers whose logarithms are uniform."""
    return np.exp(random.uniform(np.log(low), np.log(high), shape))


def example(kind: Kind, random: Random, scale: Scale) -> Shape:
    """A random shape of a kind, made from the table of its fields."""
    place = scale.offset * ways(random)
    values: dict[str, Any] = {
        each.name: value(each, random, scale, place) for each in fields_of(kind.element) if each.required
    }
    return kind.element(**values | dict(scale.lengths))


def value(field: Field, random: Random, scale: Scale, place: Array) -> object:
    """A random value of a field of a shape near a place; TypeError for a sort of field that is unknown here."""
    if isinstance(field, Point):
        return tuple(place + scale.size * random.normal(size=3))
    if isinstance(field, Direction):
        return tuple(ways(random).clip(-1, 1))
    if isinstance(field, Length):
        return scale.size * float(log(random, 0.2, 5))
    if isinstance(field, Lengths):
        return tuple(scale.size * log(random, 0.2, 5, 3))
    if isinstance(field, Real):
        return random.uniform(field.low, field.high)
    if isinstance(field, Colour):
        return GREY
    raise TypeError(f"no random value for a {type(field).__name__}")


def examples(kind: Kind, random: Random, scale: Scale, count: int) -> tuple[list[Shape], Array]:
    """Random shapes, and their middles, (m, 1, 3)."""
    shapes: list[Shape] = []
    while len(shapes) < count:
        with suppress(ValueError):  # fields that do not go together
            shapes.append(example(kind, random, scale))
    return shapes, np.array([middle(shape) for shape in shapes])[:, None]


def middle(shape: Shape) -> Array:
    """The middle of a shape; of one without end, a point that it is given by."""
    points = [centre for centre, _ in shape.balls()] or defining_points(shape)
    mean: Array = np.mean(points, axis=0)
    return mean


def towards(kind: Kind, random: Random, m: int, n: int, scale: Scale, away: tuple[float, float]) -> Rays:
    """From an eye so many sizes away at places in and around the shape: some hit and some miss."""
    shapes, places = examples(kind, random, scale, m)
    eyes = places + scale.size * log(random, *away, m, 1, 1) * ways(random, m, 1)
    targets = places + scale.size * random.uniform(-0.6, 0.6, (m, n, 3))
    return Rays(shapes, np.repeat(eyes, n, axis=1), unit(targets - eyes))


def inside(kind: Kind, random: Random, m: int, n: int, scale: Scale) -> Rays:
    """From near the middle, in all directions."""
    shapes, places = examples(kind, random, scale, m)
    return Rays(shapes, places + 0.05 * scale.size * ways(random, m, n), ways(random, m, n))


def tangent(kind: Kind, random: Random, m: int, n: int, scale: Scale, off: tuple[float, float]) -> Rays:
    """Along the surface, off it to the outside or inside by so many sizes at the point where it is nearest."""
    shapes, points, normals = touched(kind, random, m, n, scale)
    touch = points + random.choice([-1.0, 1.0], (m, n, 1)) * scale.size * log(random, *off, m, n, 1) * normals
    directions = aside(random, normals)
    return Rays(shapes, touch - scale.size * random.uniform(3, 20, (m, n, 1)) * directions, directions)


def grazing(kind: Kind, random: Random, m: int, n: int, scale: Scale, slope: tuple[float, float]) -> Rays:
    """Down onto the surface, at such a slope."""
    shapes, points, normals = touched(kind, random, m, n, scale)
    directions = unit(aside(random, normals) - log(random, *slope, m, n, 1) * normals)
    return Rays(shapes, points - scale.size * random.uniform(3, 20, (m, n, 1)) * directions, directions)


def above(kind: Kind, random: Random, m: int, n: int, scale: Scale, height: tuple[float, float]) -> Rays:
    """From so many scene units above the surface, down."""
    shapes, points, normals = touched(kind, random, m, n, scale)
    directions = unit(aside(random, normals) - random.uniform(0.1, 10, (m, n, 1)) * normals)
    return Rays(shapes, points + log(random, *height, m, n, 1) * normals, directions)


def rim(kind: Kind, random: Random, m: int, n: int, scale: Scale, off: tuple[float, float]) -> Rays:
    """At the edge between cap and side, off it by so many sizes, from everywhere."""
    shapes, _ = examples(kind, random, scale, m)
    widest = [max(shape.balls(), key=lambda ball: ball[1]) for shape in shapes]  # that of a cap
    centres, radii = np.array([ball[0] for ball in widest]), np.array([ball[1] for ball in widest])
    edge = centres[:, None] + radii[:, None, None] * aside(random, axes_of(shapes, n))
    edge += scale.size * log(random, *off, m, n, 1) * ways(random, m, n)
    directions = ways(random, m, n)
    return Rays(shapes, edge - scale.size * random.uniform(3, 20, (m, n, 1)) * directions, directions)


def along(
    kind: Kind, random: Random, m: int, n: int, scale: Scale, angle: tuple[float, float], back: float = 0.0
) -> Rays:
    """Along the axis, off it by such an angle (radians), from so many sizes before the middle."""
    shapes, places = examples(kind, random, scale, m)
    axes = axes_of(shapes, n)
    start = random.uniform(0.0, 0.6, (m, n, 1)) * lengths_of(shapes, "diameter") * aside(random, axes)
    directions = unit(axes + log(random, *angle, m, n, 1) * aside(random, axes))
    return Rays(shapes, places + start - back * scale.size * axes, directions)


def touched(kind: Kind, random: Random, m: int, n: int, scale: Scale) -> tuple[list[Shape], Array, Array]:
    """Random shapes, points on them and the normals there, (m, n, 3)."""
    shapes, places = examples(kind, random, scale, m)
    points = places + 0.5 * scale.size * ways(random, m, n)
    normals = np.empty_like(points)
    for i, shape in enumerate(shapes):
        with np.errstate(all="ignore"):
            on, out = kind.surface(shape.pack(), Vec(*points[i].T))
        points[i], normals[i] = rows(on, n), rows(out, n)
    return shapes, points, normals


def rows(v: Vec, n: int) -> Array:
    """The n vectors that a Vec of arrays, or of numbers that all share, stands for."""
    return np.stack([np.broadcast_to(part, n) for part in (v.x, v.y, v.z)], axis=-1)


def axes_of(shapes: list[Any], n: int) -> Array:
    """The axis of each shape, n times: (m, n, 3)."""
    return np.repeat(np.array([shape.axis for shape in shapes])[:, None], n, axis=1)


def lengths_of(shapes: list[Any], name: str) -> Array:
    """A length of each shape, (m, 1, 1)."""
    return np.array([getattr(shape, name) for shape in shapes])[:, None, None]
