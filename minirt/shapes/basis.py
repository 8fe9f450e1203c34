"""Orthonormal frames for shapes that have an axis or a normal."""

from __future__ import annotations

from math import copysign

from minirt.fields import Triple, cos_and_sin, upright
from minirt.lanes import Vec, dot


def basis(axis: Triple, roll: float = 0.0) -> tuple[Vec, Vec, Vec]:
    """Right-handed orthonormal basis u, v and the unit `axis` itself.

    They are the scene's z, x and y, turned no further than it takes to bring y to the axis, or to its opposite, and
    then by `roll` degrees about it. There is no branch for them and no division by a small number (Duff et al.,
    Building an Orthonormal Basis, Revisited, 2017).
    """
    x, y, z = axis
    sign = copysign(1.0, y)
    a = -1.0 / (sign + y)
    b = z * x * a
    u, v = Vec(sign * b, -sign * z, 1.0 + sign * z * z * a), Vec(sign + x * x * a, -x, b)
    return *rolled(u, v, roll), Vec(x, y, z)


def facing_frame(normal: Triple, roll: float = 0.0) -> tuple[Vec, Vec]:
    """Right and up of a flat surface: as seen by a viewer who faces it, turned by `roll` degrees counter-clockwise.

    `right`, `up` and the normal are right-handed.
    """
    x, y, z = normal
    right, up = upright(-x, -y, -z)
    return rolled(Vec(*right), Vec(*up), roll)


def rolled(u: Vec, v: Vec, roll: float) -> tuple[Vec, Vec]:
    """Turn two perpendicular unit vectors in their plane, by `roll` degrees from u towards v."""
    if not roll:
        return u, v
    c, s = cos_and_sin(roll)
    return c * u + s * v, c * v - s * u


def to_basis(u: Vec, v: Vec, w: Vec, p: Vec) -> Vec:
    """Transform the vector p into the frame u, v, w."""
    return Vec(dot(p, u), dot(p, v), dot(p, w))


def from_basis(u: Vec, v: Vec, w: Vec, p: Vec) -> Vec:
    """Transform p, coordinates in the frame u, v, w, back into the scene."""
    return p.x * u + p.y * v + p.z * w
