"""Texture coordinates of solids of revolution: around the side, and on the caps.

Points, normals and tangents are in the frame of `minirt.shapes.basis.basis`, whose third vector is the axis.
"""

from __future__ import annotations

from math import pi

from minirt.lanes import Mask, Number, Vec, copysign, splat, where
from minirt.lanes.mathematics import arctan2
from minirt.shapes.basis import from_basis

TWO_PI = 2.0 * pi


def angle_in_turns(y: Number, x: Number) -> Number:
    """The angle from the x axis to (x, y) in turns, from -1/2 to 1/2."""
    return arctan2(y, x) * (1.0 / TWO_PI)


def longitude(p: Vec) -> tuple[Number, Vec]:
    """The angle about the axis, from 0 to 1, counter-clockwise as seen from its tip, 1/2 at -x; and the tangent."""
    return 0.5 + angle_in_turns(-p.y, -p.x), Vec(-TWO_PI * p.y, TWO_PI * p.x, 0.0)


def is_side(p: Vec, normal: Vec) -> Mask:
    """Whether a point is on the side and not on a cap, whose normal points away along the axis."""
    return copysign(1.0, p.z) * normal.z < 0.5


def revolved_mapping(
    u: Vec, v: Vec, w: Vec, p: Vec, side: Mask, height: Number, rise: Vec, radius: Number
) -> tuple[Number, Number, Vec, Vec]:
    """`mapping` of a solid of revolution with the frame u, v, w, for a point p on its side or on a cap.

    On the side v is `height` and its tangent `rise`. On a cap, which has this radius, a picture fills the square around
    it once; where the axis points up it lies as on a floor or a ceiling.
    """
    flat = splat(0.0, p.x)
    across = 2.0 * radius
    per_diameter = 1.0 / across
    up = -copysign(1.0, p.z)  # of the picture on a cap, along u
    turn, way = longitude(p)
    return (
        where(side, turn, 0.5 + p.y * per_diameter),
        where(side, height, 0.5 + up * p.x * per_diameter),
        from_basis(u, v, w, where(side, way, Vec(flat, across, flat))),
        from_basis(u, v, w, where(side, rise, Vec(up * across, flat, flat))),
    )
