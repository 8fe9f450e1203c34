"""Random shapes and random rays at them, for the regimes. Lengths are in units of the shape's size."""

from __future__ import annotations

from contextlib import suppress
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.element import fields_of
from minirt.fields import Colour, Direction, Field, Length, Lengths, Point, Real
from minirt.lanes import Vec
from minirt.rendering.packing.shape_arrays import defining_points
from minirt.shapes import Kind, Shape

Array = NDArray[np.float64]
Random = np.random.Generator
GREY = (128, 128, 128)


class Rays(NamedTuple):
    """m shapes of one type, and n rays for each."""

    shapes: list[Shape]
    origins: Array  # (m, n, 3)
    directions: Array  # (m, n, 3), unit


class Scale(NamedTuple):
    """Size of random shapes in scene units, and their distance from the scene's origin."""

    size: float = 1.0
    offset: float = 0.0
    lengths: tuple[tuple[str, float], ...] = ()  # (field, fixed value)


def unit(v: Array) -> Array:
    """Normalise vectors of any length, without overflow or underflow."""
    scaled: Array = v / np.abs(v).max(axis=-1, keepdims=True)
    scaled /= np.linalg.norm(scaled, axis=-1, keepdims=True)
    return scaled


def random_directions(random: Random, *shape: int) -> Array:
    """Return random unit vectors, uniform over the sphere."""
    return unit(random.normal(size=(*shape, 3)))


def random_perpendiculars(random: Random, axes: Array) -> Array:
    """Return a random unit vector perpendicular to each axis."""
    return unit(np.cross(random_directions(random, *axes.shape[:-1]), axes))


def log_uniform(random: Random, low: float, high: float, *shape: int) -> Array:
    """Return random numbers whose logarithms are uniform."""
    return np.exp(random.uniform(np.log(low), np.log(high), shape))


def random_shape(kind: Kind, random: Random, scale: Scale) -> Shape:
    """Make a random shape of a type from the declarations of its fields."""
    place = scale.offset * random_directions(random)
    values: dict[str, Any] = {
        each.name: random_value(each, random, scale, place) for each in fields_of(kind.element) if each.required
    }
    return kind.element(**values | dict(scale.lengths))


def random_value(field: Field, random: Random, scale: Scale, place: Array) -> object:
    """Return a random value for a field of a shape near a place; TypeError for an unknown type of field."""
    if isinstance(field, Point):
        return tuple(place + scale.size * random.normal(size=3))
    if isinstance(field, Direction):
        return tuple(random_directions(random).clip(-1, 1))
    if isinstance(field, Length):
        return scale.size * float(log_uniform(random, 0.2, 5))
    if isinstance(field, Lengths):
        return tuple(scale.size * log_uniform(random, 0.2, 5, 3))
    if isinstance(field, Real):
        return random.uniform(field.low, field.high)
    if isinstance(field, Colour):
        return GREY
    raise TypeError(f"no random value for a {type(field).__name__}")


def random_shapes(kind: Kind, random: Random, scale: Scale, count: int) -> tuple[list[Shape], Array]:
    """Make random shapes; return them and their middles, (m, 1, 3)."""
    shapes: list[Shape] = []
    while len(shapes) < count:
        with suppress(ValueError):  # values that do not go together
            shapes.append(random_shape(kind, random, scale))
    return shapes, np.array([middle(shape) for shape in shapes])[:, None]


def middle(shape: Shape) -> Array:
    """Return the middle of a shape; for an infinite shape, a point that defines it."""
    points = [centre for centre, _ in shape.balls()] or defining_points(shape)
    mean: Array = np.mean(points, axis=0)
    return mean


def rays_towards(kind: Kind, random: Random, m: int, n: int, scale: Scale, away: tuple[float, float]) -> Rays:
    """Rays from an eye `away` sizes away at points in and around the shape: some hit and some miss."""
    shapes, places = random_shapes(kind, random, scale, m)
    eyes = places + scale.size * log_uniform(random, *away, m, 1, 1) * random_directions(random, m, 1)
    targets = places + scale.size * random.uniform(-0.6, 0.6, (m, n, 3))
    return Rays(shapes, np.repeat(eyes, n, axis=1), unit(targets - eyes))


def rays_from_inside(kind: Kind, random: Random, m: int, n: int, scale: Scale) -> Rays:
    """Rays from near the middle in all directions."""
    shapes, places = random_shapes(kind, random, scale, m)
    return Rays(shapes, places + 0.05 * scale.size * random_directions(random, m, n), random_directions(random, m, n))


def tangent_rays(kind: Kind, random: Random, m: int, n: int, scale: Scale, off: tuple[float, float]) -> Rays:
    """Rays along the surface, `off` sizes outside or inside of it at the nearest point."""
    shapes, points, normals = random_surface_points(kind, random, m, n, scale)
    touch = points + random.choice([-1.0, 1.0], (m, n, 1)) * scale.size * log_uniform(random, *off, m, n, 1) * normals
    directions = random_perpendiculars(random, normals)
    return Rays(shapes, touch - scale.size * random.uniform(3, 20, (m, n, 1)) * directions, directions)


def grazing_rays(kind: Kind, random: Random, m: int, n: int, scale: Scale, slope: tuple[float, float]) -> Rays:
    """Rays down onto the surface at a slope."""
    shapes, points, normals = random_surface_points(kind, random, m, n, scale)
    directions = unit(random_perpendiculars(random, normals) - log_uniform(random, *slope, m, n, 1) * normals)
    return Rays(shapes, points - scale.size * random.uniform(3, 20, (m, n, 1)) * directions, directions)


def rays_from_above(kind: Kind, random: Random, m: int, n: int, scale: Scale, height: tuple[float, float]) -> Rays:
    """Rays down onto the surface from a height in scene units."""
    shapes, points, normals = random_surface_points(kind, random, m, n, scale)
    directions = unit(random_perpendiculars(random, normals) - random.uniform(0.1, 10, (m, n, 1)) * normals)
    return Rays(shapes, points + log_uniform(random, *height, m, n, 1) * normals, directions)


def rays_at_rims(kind: Kind, random: Random, m: int, n: int, scale: Scale, off: tuple[float, float]) -> Rays:
    """Rays from everywhere at the edge between cap and side, `off` sizes beside it."""
    shapes, _ = random_shapes(kind, random, scale, m)
    widest = [max(shape.balls(), key=lambda ball: ball[1]) for shape in shapes]  # the ball around the larger cap
    centres, radii = np.array([ball[0] for ball in widest]), np.array([ball[1] for ball in widest])
    edge = centres[:, None] + radii[:, None, None] * random_perpendiculars(random, axes_of(shapes, n))
    edge += scale.size * log_uniform(random, *off, m, n, 1) * random_directions(random, m, n)
    directions = random_directions(random, m, n)
    return Rays(shapes, edge - scale.size * random.uniform(3, 20, (m, n, 1)) * directions, directions)


def axial_rays(
    kind: Kind, random: Random, m: int, n: int, scale: Scale, angle: tuple[float, float], back: float = 0.0
) -> Rays:
    """Rays along the axis, off it by an angle in radians, from `back` sizes before the middle."""
    shapes, places = random_shapes(kind, random, scale, m)
    axes = axes_of(shapes, n)
    start = random.uniform(0.0, 0.6, (m, n, 1)) * lengths_of(shapes, "diameter") * random_perpendiculars(random, axes)
    directions = unit(axes + log_uniform(random, *angle, m, n, 1) * random_perpendiculars(random, axes))
    return Rays(shapes, places + start - back * scale.size * axes, directions)


def random_surface_points(kind: Kind, random: Random, m: int, n: int, scale: Scale) -> tuple[list[Shape], Array, Array]:
    """Make random shapes; return them, points on them and the normals there, (m, n, 3)."""
    shapes, places = random_shapes(kind, random, scale, m)
    points = places + 0.5 * scale.size * random_directions(random, m, n)
    normals = np.empty_like(points)
    for i, shape in enumerate(shapes):
        with np.errstate(all="ignore"):
            on, out = kind.surface(shape.pack(), Vec(*points[i].T))
        points[i], normals[i] = vec_rows(on, n), vec_rows(out, n)
    return shapes, points, normals


def vec_rows(v: Vec, n: int) -> Array:
    """Return a Vec of arrays or of single numbers as an array (n, 3)."""
    return np.stack([np.broadcast_to(part, n) for part in (v.x, v.y, v.z)], axis=-1)


def axes_of(shapes: list[Any], n: int) -> Array:
    """Return the axis of each shape, repeated n times, (m, n, 3)."""
    return np.repeat(np.array([shape.axis for shape in shapes])[:, None], n, axis=1)


def lengths_of(shapes: list[Any], name: str) -> Array:
    """Return a length field of each shape, (m, 1, 1)."""
    return np.array([getattr(shape, name) for shape in shapes])[:, None, None]
