"""Vectors of three numbers, with the operators of a vector space."""

from __future__ import annotations

from typing import Any

Number = Any  # a numpy float64, an array with one for each ray, or a SIMD vector


class Vec:
    """A vector or a point: x, y and z, each a number in the sense of `minirt.lanes`."""

    __array_ufunc__ = None  # an array times a Vec is a Vec, not an array of Vecs
    __slots__ = ("x", "y", "z")

    def __init__(self, x: Number, y: Number, z: Number) -> None:
        self.x, self.y, self.z = x, y, z

    def __add__(self, other: Vec) -> Vec:
        return Vec(self.x + other.x, self.y + other.y, self.z + other.z)

    def __sub__(self, other: Vec) -> Vec:
        return Vec(self.x - other.x, self.y - other.y, self.z - other.z)

    def __mul__(self, factor: Number) -> Vec:
        return Vec(self.x * factor, self.y * factor, self.z * factor)

    __rmul__ = __mul__

    def __truediv__(self, divisor: Number) -> Vec:
        """Multiply by the inverse: one division instead of three, at the cost of a second rounding."""
        return self * (1.0 / divisor)

    def __neg__(self) -> Vec:
        return Vec(-self.x, -self.y, -self.z)

    def __repr__(self) -> str:
        return f"Vec({self.x}, {self.y}, {self.z})"


def cross(a: Vec, b: Vec) -> Vec:
    """Return the cross product."""
    return Vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)


def dot(a: Vec, b: Vec) -> Number:
    """Return the dot product."""
    return a.x * b.x + a.y * b.y + a.z * b.z
