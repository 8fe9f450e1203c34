"""Orthonormal frames for shapes that have an axis or a normal, and texture coordinates of solids of revolution."""

from __future__ import annotations

import math
from typing import Any

from minirt.fields import Triple, cos_and_sin, upright
from minirt.lanes import Mask, Number, Vec, copysign, dot, splat, where
from minirt.lanes.mathematics import arctan2

TWO_PI = 2.0 * math.pi
Mapped = tuple[Number, Number, Vec, Vec]  # u, v and the tangents along them


def basis(axis: Triple, roll: float = 0.0) -> tuple[Vec, Vec, Vec]:
    """Right-handed orthonormal basis u, v and the unit `axis` itself.

    They are the scene's z, x and y, turned no further than it takes to bring y to the axis, or to its opposite, and
    then by `roll` degrees about it. There is no branch for them and no division by a small number (Duff et al.,
    Building an Orthonormal Basis, Revisited, 2017).
    """
    x, y, z = axis
    sign = math.copysign(1.0, y)
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


# The own frame of a packed shape: its vectors u, v and w, and its `centre` as the origin.


def own_point(shape: Any, point: Vec) -> Vec:
    """Transform a point of the scene into the shape's own frame."""
    return to_basis(shape.u, shape.v, shape.w, point - shape.centre)


def own_direction(shape: Any, direction: Vec) -> Vec:
    """Transform a direction into the shape's own frame."""
    return to_basis(shape.u, shape.v, shape.w, direction)


def in_scene(shape: Any, point: Vec, direction: Vec) -> tuple[Vec, Vec]:
    """Transform a point and a direction of the shape's own frame back into the scene."""
    return shape.centre + scene_direction(shape, point), scene_direction(shape, direction)


def scene_direction(shape: Any, direction: Vec) -> Vec:
    """Transform a direction of the shape's own frame back into the scene."""
    return from_basis(shape.u, shape.v, shape.w, direction)


# Texture coordinates around the side and on the caps of solids of revolution. Points, normals and tangents are in the
# frame of `basis`, whose third vector is the axis.


def angle_in_turns(y: Number, x: Number) -> Number:
    """The angle from the x axis to (x, y) in turns, from -1/2 to 1/2."""
    return arctan2(y, x) * (1.0 / TWO_PI)


def longitude(p: Vec) -> tuple[Number, Vec]:
    """The angle about the axis, from 0 to 1, counter-clockwise as seen from its tip, 1/2 at -x; and the tangent."""
    return 0.5 + angle_in_turns(-p.y, -p.x), Vec(-TWO_PI * p.y, TWO_PI * p.x, 0.0)


def revolved_mapping(u: Vec, v: Vec, w: Vec, p: Vec, side: Mask, height: Number, rise: Vec, radius: Number) -> Mapped:
    """`mapping` of a solid of revolution with the frame u, v, w, for a point p on its `side` or on a cap.

    p is in the frame. On the side the second texture coordinate is `height`, and its tangent `rise`, in the frame, too.
    On a cap, which has this radius, a picture fills the square around it once; where the axis points up it lies as on
    a floor or a ceiling.
    """
    flat = splat(0.0, p.x)
    diameter = 2.0 * radius
    per_diameter = 1.0 / diameter
    up = -copysign(1.0, p.z)  # of the picture on a cap, along u
    turn, way = longitude(p)
    return (
        where(side, turn, 0.5 + p.y * per_diameter),
        where(side, height, 0.5 + up * p.x * per_diameter),
        from_basis(u, v, w, where(side, way, Vec(flat, diameter, flat))),
        from_basis(u, v, w, where(side, rise, Vec(up * diameter, flat, flat))),
    )


def capped_mapping(shape: Any, p: Vec, normal: Vec, height: Number, rise: Vec, radius: Number) -> Mapped:
    """`revolved_mapping` of a packed shape, for a point and a normal in its own frame."""
    side = copysign(1.0, p.z) * normal.z < 0.5  # that of a cap points away along the axis
    return revolved_mapping(shape.u, shape.v, shape.w, p, side, height, rise, radius)
