"""Vectors as arrays (..., 3), and frames."""

from __future__ import annotations

from contextvars import ContextVar

import numpy as np
from numpy.typing import NDArray

from minirt.element import fields_of
from minirt.fields import Point
from minirt.shapes import Shape

Array = NDArray[np.float64]


def dot(a: Array, b: Array) -> Array:
    return np.asarray(np.sum(a * b, axis=-1))


def length(a: Array) -> Array:
    return np.sqrt(dot(a, a))


def unit(a: Array) -> Array:
    """Scale vectors to length 1; NaN for zero vectors."""
    with np.errstate(invalid="ignore"):
        return np.asarray(a / length(a)[..., None])


DECODED: ContextVar[bool] = ContextVar("DECODED", default=False)  # whether colours are decoded by the curve of sRGB


def rgb(colour: tuple[float, float, float] | Array) -> Array:
    values = np.array(colour) / 255.0
    if not DECODED.get():
        return values
    return np.where(values > 0.04045, ((values + 0.055) / 1.055) ** 2.4, values / 12.92)  # IEC 61966-2-1


def right_and_up(forward: Array) -> tuple[Array, Array]:
    """Right and up of an upright view along a unit vector; for a view straight down up is -z."""
    x, _, z = forward
    level = np.hypot(x, z)
    right = np.array([-z, 0.0, x]) / level if level > 0 else np.array([1.0, 0.0, 0.0])  # forward cross +y
    return right, np.cross(right, forward)


def turned(v: Array, about: Array, degrees: float) -> Array:
    """Turn vectors about a unit vector, right-handed (Rodrigues)."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.asarray(v * c + np.cross(about, v) * s + dot(v, about)[..., None] * about * (1 - c))


def own_x_and_z(axis: Array, roll: float) -> tuple[Array, Array]:
    """A right-handed frame's x and z, where y is the axis: z is the scene's after the smallest rotation that takes y to
    the axis or, if that points down, to its opposite, and after a turn about the axis."""
    to = axis if axis[1] >= 0 else -axis
    y = np.array([0.0, 1.0, 0.0])
    about, cosine = np.cross(y, to), to[1]

    def turn(v: Array) -> Array:  # Rodrigues
        return np.asarray(v * cosine + np.cross(about, v) + about * dot(about, v) / (1 + cosine))

    z = turned(turn(np.array([0.0, 0.0, 1.0])), axis, roll)
    return np.cross(axis, z), z


def first_point(shape: Shape) -> Array:
    """The first point that a shape is given by."""
    return np.array(next(getattr(shape, each.name) for each in fields_of(type(shape)) if isinstance(each, Point)))
