"""Vectors as arrays (..., 3), and frames."""

from __future__ import annotations

from contextvars import ContextVar
from typing import Any

import numpy as np
from numpy.typing import NDArray

from minirt.element import fields_of
from minirt.fields import Point
from minirt.shapes import Shape
from tests.oracle.body import Polynomial

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


class Along(Polynomial):
    """Polynomials of the oracle in float64, one for each ray."""

    @staticmethod
    def number(c: Any) -> Any:
        return c if isinstance(c, np.ndarray) else np.float64(float(c))

    def roots(self) -> list[Array]:  # type: ignore[override]
        """The real roots, NaN or infinite where there is none."""
        c = np.broadcast_arrays(*self.coefficients)
        with np.errstate(all="ignore"):
            if len(c) == 2:
                return [-c[0] / c[1]]
            if len(c) == 3:
                b = c[1] / 2
                q = -(b + np.copysign(np.sqrt(b * b - c[2] * c[0]), b))
                return [q / c[2], c[0] / q]
        # Eigenvalues of the companion matrix.
        companion = np.zeros((*c[0].shape, len(c) - 1, len(c) - 1))
        companion[..., 1:, :-1] = np.eye(len(c) - 2)
        companion[..., -1] = -np.stack(c[:-1], axis=-1) / c[-1][..., None]
        roots = np.moveaxis(np.linalg.eigvals(companion), -1, 0)
        return [np.where(np.abs(root.imag) < 1e-6 * np.abs(roots).max(axis=0), root.real, np.nan) for root in roots]

    def rounding(self, t: Array) -> Array:
        """An error that the values at t may have."""
        return np.asarray(1e-12 * Along(*map(np.abs, self.coefficients))(np.abs(t)))


def first_point(shape: Shape) -> Array:
    """The first point that a shape is given by."""
    return np.array(next(getattr(shape, each.name) for each in fields_of(type(shape)) if isinstance(each, Point)))
