"""How pictures lie on what turns about an axis: around the side, and on the caps.

Points, normals and tangents are those of the frame of `minirt.shapes.basis.basis`, whose third vector is the axis.
"""

from __future__ import annotations

from math import pi

from minirt.lanes import Vec, copysign, splat, where
from minirt.lanes.angle import arctan2
from minirt.lanes.operations import Mask
from minirt.lanes.vec import Number
from minirt.shapes.basis import from_basis

TWO_PI = 2.0 * pi


def angle_in_turns(y: Number, x: Number) -> Number:
    """The angle from the x axis to (x, y) in whole turns, from -1/2 to 1/2."""
    return arctan2(y, x) * (1.0 / TWO_PI)


def longitude(p: Vec) -> tuple[Number, Vec]:
    """From 0 to 1 about the axis, counter-clockwise from its tip, 1/2 at -x; and the way there for each turn."""
    return 0.5 + angle_in_turns(-p.y, -p.x), Vec(-TWO_PI * p.y, TWO_PI * p.x, 0.0)


def is_side(p: Vec, normal: Vec) -> Mask:
    """Whether a point is on the side: the normal of a cap points away along the axis."""
    return copysign(1.0, p.z) * normal.z < 0.5


def revolved_mapping(
    u: Vec, v: Vec, w: Vec, p: Vec, side: Mask, height: Number, rise: Vec, radius: Number
) -> tuple[Number, Number, Vec, Vec]:
    """`mapping` of a shape with the frame u, v, w whose point p has on the side the coordinate `height` and the tangent
    `rise` along it, and whose caps have a radius.

    A picture fills the square around a cap once. Where the axis points up it lies as on a floor or a ceiling.
    """
    flat = splat(0.0, p.x)
    across = 2.0 * radius
    per_diameter = 1.0 / across
    up = -copysign(1.0, p.z)  # along u, on a cap
    turn, way = longitude(p)
    return (
        where(side, turn, 0.5 + p.y * per_diameter),
        where(side, height, 0.5 + up * p.x * per_diameter),
        from_basis(u, v, w, where(side, way, Vec(flat, across, flat))),
        from_basis(u, v, w, where(side, rise, Vec(up * across, flat, flat))),
    )
