"""Orthonormal frames for shapes that have an axis."""

from __future__ import annotations

from math import copysign

from minirt.fields import Triple
from minirt.lanes import Vec, dot


def basis(axis: Triple) -> tuple[Vec, Vec, Vec]:
    """Unit vectors u, v and the unit `axis` itself, perpendicular to each other and right-handed.

    Without a branch or a division by a small number (Duff et al., Building an Orthonormal Basis, Revisited, 2017).
    """
    x, y, z = axis
    sign = copysign(1.0, z)
    a = -1.0 / (sign + z)
    b = x * y * a
    return Vec(1.0 + sign * x * x * a, sign * b, -sign * x), Vec(b, sign + y * y * a, -y), Vec(x, y, z)


def to_basis(u: Vec, v: Vec, w: Vec, p: Vec) -> Vec:
    """The coordinates of p in the frame u, v, w."""
    return Vec(dot(p, u), dot(p, v), dot(p, w))


def from_basis(u: Vec, v: Vec, w: Vec, p: Vec) -> Vec:
    """The vector whose coordinates in the frame u, v, w are p."""
    return p.x * u + p.y * v + p.z * w
