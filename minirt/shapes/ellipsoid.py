"""Ellipsoid: `el x,y,z ax,ay,az w,h,d R,G,B`.

A solid ellipsoid. `x,y,z` is its centre, `ax,ay,az` its own y axis, and `w,h,d` are its diameters along its own x, y
and z axes. As for a box these are the axes of the scene, turned no further than it takes to bring y to `ax,ay,az`, or
to its opposite, and `roll:degrees` then turns it about its own y axis. A picture lies on it as on a sphere that is
stretched together with it.

    el 0,1,20  0,1,0  6,2,4  200,120,160    a pebble six wide, two high and four deep
"""

from __future__ import annotations

from math import hypot
from typing import Any, NamedTuple

from minirt.fields import Colour, Direction, Lengths, Point, Triple, declare
from minirt.lanes import Number, Vec, any, dot, fabs, outlined, rarely, splat, sqrt, unit, unit_roundoff, where
from minirt.records import record
from minirt.shapes.boundary import Boundary, own_coordinates
from minirt.shapes.compensated import (
    Pairs,
    divided,
    minus,
    offset,
    pair,
    pairs,
    position_error,
    rounded,
    scalar_product,
    value,
)
from minirt.shapes.frames import TWO_PI, angle_in_turns, in_scene, own_direction, own_point, scene_direction
from minirt.shapes.quadrics import CLOSE, ROUNDING, exact_ends, negative_interval
from minirt.shapes.shape import Axial, Ball, Bounds, Hit, Position, point_along


@record()
class Ellipsoid(Axial):
    """A line `el` of a scene file."""

    code, title, plural = "el", "ellipsoid", "ellipsoids"
    centre: Triple = declare(Point, "centre")
    axis: Triple = declare(Direction, "its own y axis")
    sizes: Triple = declare(Lengths, "diameters along its own x, y and z axes", names="w,h,d")
    colour: Triple = declare(Colour, "colour")

    def pack(self) -> PackedEllipsoid:
        z, x, y = self.frame()
        a, b, c = (size / 2 for size in self.sizes)
        return PackedEllipsoid(Position(Vec(*self.centre)), x, y, z, Vec(a, b, c), Vec(1 / a, 1 / b, 1 / c))

    def axes(self) -> list[tuple[float, Triple]]:
        """The semi-axes in ascending order, each with its unit direction."""
        z, x, y = self.frame()
        directions = ((axis.x, axis.y, axis.z) for axis in (x, y, z))
        return sorted(zip((size / 2 for size in self.sizes), directions, strict=True))

    def balls(self) -> tuple[Ball, ...]:
        """Four balls with the least semi-axis c as radius, a - c and b - c off the centre along the axes a and b."""
        (c, _), (b, middle), (a, longest) = self.axes()
        ends = (point_along(self.centre, longest, sign * (a - c)) for sign in (-1, 1))
        return tuple((point_along(end, middle, sign * (b - c)), c) for end in ends for sign in (-1, 1))

    def bounds(self) -> Bounds:
        (x, y, z), axes = self.centre, self.axes()
        i, j, k = (hypot(*(length * axis[part] for length, axis in axes)) for part in range(3))
        return (x - i, y - j, z - k), (x + i, y + j, z + k)


class PackedEllipsoid(NamedTuple):
    """Packed form of an ellipsoid: its own frame, and the scale that makes it the unit sphere there."""

    centre: Position
    u: Vec
    v: Vec
    w: Vec
    semi: Vec  # the semi-axes along u, v and w
    scale: Vec  # 1 / semi


def intersect(ellipsoid: PackedEllipsoid, origin: Vec, direction: Vec, limit: Number | None = None) -> Hit:
    """Whether a ray meets the ellipsoid, and the least t > 0 at which it does; `limit` as in `minirt.shapes.shape`.

    In its own frame, divided by its semi-axes, the ellipsoid is the unit sphere, and t along the scaled ray is the
    same. As for a sphere the roots are found from the ray's closest approach to the centre, q, which keeps full
    precision for small ellipsoids that are far away. A ray that starts close to the surface, inside or towards the
    centre, is solved exactly.
    """
    p = scaled(own_point(ellipsoid, origin), ellipsoid.scale)
    d = scaled(own_direction(ellipsoid, direction), ellipsoid.scale)
    a = dot(d, d)
    per_a = 1.0 / a
    b = dot(p, d)
    approach = -b * per_a
    q = p + approach * d
    b_q = dot(q, d)
    below, above = negative_interval(a, per_a, b_q, dot(q, q) - 1.0, approach)
    if limit is None:  # the ray may start on the surface
        level = dot(p, p) - 1.0  # of the start: 0 on the surface
        if rarely(fabs(level) <= CLOSE):
            may_hit = (b < 0.0) | (level <= ROUNDING * unit_roundoff(a))
            close = (fabs(level) <= CLOSE) & may_hit
            if any(close):
                exact_below, exact_above = exact_interval(ellipsoid, origin, direction, a)
                below, above = where(close, exact_below, below), where(close, exact_above, above)
    t = where(below > 0.0, below, above)
    return t > 0.0, t  # NaN where there is no hit


@outlined
def exact_interval(ellipsoid: PackedEllipsoid, origin: Vec, direction: Vec, like: Number) -> tuple[Number, Number]:
    """Compute t at which a line enters and leaves the ellipsoid, without cancellation (`minirt.shapes.quadrics`)."""
    f = offset(splat(origin, like), splat(ellipsoid.centre, like))
    p, d = in_unit_sphere(ellipsoid, f), in_unit_sphere(ellipsoid, pairs(direction, like))
    slope, turn = scaled(rounded(p), ellipsoid.scale), scaled(rounded(d), ellipsoid.scale)
    c = minus(scalar_product(p, p), pair(1.0, 0.0, like))
    error = position_error(splat(origin, like), rounded(f))
    on = value(c) * value(c) <= 4.0 * dot(slope, slope) * error * error
    below, above, _ = exact_ends(scalar_product(d, d), scalar_product(p, d), c, on, dot(turn, turn) * error * error)
    return below, above


def in_unit_sphere(ellipsoid: PackedEllipsoid, v: Pairs) -> Pairs:
    """Transform a vector into the own frame of an ellipsoid, divided by its semi-axes."""
    like = v[0][0]
    semi = splat(ellipsoid.semi, like)
    x = scalar_product(v, pairs(ellipsoid.u, like))
    y = scalar_product(v, pairs(ellipsoid.v, like))
    z = scalar_product(v, pairs(ellipsoid.w, like))
    return divided(x, semi.x), divided(y, semi.y), divided(z, semi.z)


def surface(ellipsoid: PackedEllipsoid, point: Vec) -> tuple[Vec, Vec]:
    """`point` moved onto the surface along the normal, to first order, and the outward normal there."""
    p = own_point(ellipsoid, point)
    q = scaled(p, ellipsoid.scale)
    slope = scaled(q, ellipsoid.scale)  # half of the gradient of |q|^2
    above = 0.5 * (dot(q, q) - 1.0) / dot(slope, slope)
    q = unit(scaled(p - above * slope, ellipsoid.scale))
    return in_scene(ellipsoid, scaled(q, ellipsoid.semi), unit(scaled(q, ellipsoid.scale)))


def mapping(ellipsoid: PackedEllipsoid, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """Longitude as u and latitude as v on the unit sphere, each from 0 to 1. At the poles the tangents are zero."""
    q = unit(scaled(own_direction(ellipsoid, normal), ellipsoid.semi))
    rho = sqrt(q.x * q.x + q.z * q.z)
    fall = -q.y / where(rho == 0.0, 1.0, rho)
    around = scaled(TWO_PI * Vec(q.z, 0.0, -q.x), ellipsoid.semi)
    upwards = scaled(0.5 * TWO_PI * Vec(fall * q.x, rho, fall * q.z), ellipsoid.semi)
    u, v = 0.5 + angle_in_turns(-q.x, -q.z), 0.5 + 2.0 * angle_in_turns(q.y, rho)
    return u, v, scene_direction(ellipsoid, around), scene_direction(ellipsoid, upwards)


def scaled(v: Vec, scale: Vec) -> Vec:
    """The vector v, scaled by its own factor along each axis."""
    return Vec(v.x * scale.x, v.y * scale.y, v.z * scale.z)


def boundary(ellipsoid: Any, point: Vec) -> Boundary:
    """(x / a)^2 + (y / b)^2 + (z / c)^2 - 1 along its own axes, for the semi-axes a, b and c."""
    x, y, z = own_coordinates(ellipsoid.axis, ellipsoid.roll, point - ellipsoid.centre)
    x, y, z = 2 * x / ellipsoid.sizes.x, 2 * y / ellipsoid.sizes.y, 2 * z / ellipsoid.sizes.z
    return Boundary((x * x + y * y + z * z - 1.0,))
