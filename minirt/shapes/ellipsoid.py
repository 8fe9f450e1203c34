"""Ellipsoid: `el x,y,z ax,ay,az w,h,d R,G,B`.

A solid ellipsoid. `x,y,z` is its centre, `ax,ay,az` its own y axis, and `w,h,d` are its diameters along its own x, y
and z axes. As for a box these are the axes of the scene, turned no further than it takes to bring y to `ax,ay,az`, or
to its opposite, and `roll:degrees` then turns it about its own y axis. A picture lies on it as on a sphere that is
stretched together with it.

    el 0,1,20  0,1,0  6,2,4  200,120,160    a pebble six wide, two high and four deep
"""

from __future__ import annotations

from math import hypot
from sys import float_info
from typing import Any, NamedTuple

from minirt.fields import Colour, Direction, Lengths, Point, Triple, declare
from minirt.lanes import Mask, Number, Vec, any, dot, fabs, rarely, splat, sqrt, unit, unit_roundoff, where
from minirt.records import record
from minirt.shapes.boundary import Boundary, own_coordinates
from minirt.shapes.compensated import along, basis_low, divided, minus, offset, plus, times, value
from minirt.shapes.frames import TWO_PI, angle_in_turns, in_scene, own_direction, own_point, scene_direction
from minirt.shapes.quadrics import CLOSE, ROUNDING, negative_interval, position_error, zero_within
from minirt.shapes.shape import Axial, Ball, Bounds, Position, point_along

SHORTEST = float_info.min  # semi-axis, in scene units: half of a subnormal size may be 0


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
        a, b, c = self.semi_axes()
        z_low, x_low, y_low = basis_low(self.axis, self.roll, z, x, y)
        centre, semi, scale = Position(Vec(*self.centre)), Vec(a, b, c), Vec(1 / a, 1 / b, 1 / c)
        return PackedEllipsoid(centre, x, y, z, x_low, y_low, z_low, semi, scale)

    def semi_axes(self) -> Triple:
        width, height, depth = self.sizes
        return max(width / 2, SHORTEST), max(height / 2, SHORTEST), max(depth / 2, SHORTEST)

    def axes(self) -> list[tuple[float, Triple]]:
        """The semi-axes in ascending order, each with its unit direction."""
        z, x, y = self.frame()
        directions = ((axis.x, axis.y, axis.z) for axis in (x, y, z))
        return sorted(zip(self.semi_axes(), directions, strict=True))

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
    u_low: Vec  # what the rounded vectors lack
    v_low: Vec
    w_low: Vec
    semi: Vec  # the semi-axes along u, v and w
    scale: Vec  # 1 / semi


def intersect(
    ellipsoid: PackedEllipsoid, origin: Vec, direction: Vec, anywhere: bool | None = True
) -> tuple[Mask, Number]:
    """Whether and where a ray meets the ellipsoid.

    In its own frame, divided by its semi-axes, it is the unit sphere, and t along the scaled ray is the same. As for a
    sphere t is counted from the ray's closest approach to the centre, which keeps full precision for small ellipsoids
    that are far away.
    """
    p = scaled(own_point(ellipsoid, origin), ellipsoid.scale)
    d = scaled(own_direction(ellipsoid, direction), ellipsoid.scale)
    a = dot(d, d)
    per_a = 1.0 / a
    b = dot(p, d)
    approach = -b * per_a
    q = p + approach * d
    half_b = dot(q, d)
    product = c = dot(q, q) - 1.0
    if anywhere is not None:
        level = dot(p, p) - 1.0
        if rarely(fabs(level) <= CLOSE):
            close = (fabs(level) <= CLOSE) & ((b < 0.0) | (level <= ROUNDING * unit_roundoff(a)))
            if any(close):
                exact_level = level_of(ellipsoid, origin, a)
                error = position_error(origin, scaled(p, ellipsoid.semi))
                slope = scaled(p, ellipsoid.scale)
                approach, half_b, c = where(close, 0.0, approach), where(close, b, half_b), where(close, exact_level, c)
                product = where(close, zero_within(c, 2.0 * sqrt(dot(slope, slope)) * error), c)
    hit, enter, leave = negative_interval(a, per_a, half_b, c, product)
    t = approach
    if any(hit):
        near = approach + enter
        t = where(near > 0.0, near, approach + leave)
        hit = hit & (t > 0.0)
    return hit, t


def level_of(ellipsoid: PackedEllipsoid, point: Vec, like: Number) -> Number:
    """Return |p|^2 - 1 of the point p on the scale of the unit sphere, to nearly full precision next to it too."""
    f = offset(splat(point, like), splat(ellipsoid.centre, like))
    semi, scale = splat(ellipsoid.semi, like), splat(ellipsoid.scale, like)
    x = divided(along(f, splat(ellipsoid.u, like), splat(ellipsoid.u_low, like)), semi.x, scale.x)
    y = divided(along(f, splat(ellipsoid.v, like), splat(ellipsoid.v_low, like)), semi.y, scale.y)
    z = divided(along(f, splat(ellipsoid.w, like), splat(ellipsoid.w_low, like)), semi.z, scale.z)
    zero = splat(0.0, like)
    return value(plus(minus(plus(times(x, x), times(y, y)), (zero + 1.0, zero)), times(z, z)))


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
    around = TWO_PI * Vec(q.z, 0.0, -q.x)
    upwards = 0.5 * TWO_PI * Vec(fall * q.x, rho, fall * q.z)
    return (
        0.5 + angle_in_turns(-q.x, -q.z),
        0.5 + 2.0 * angle_in_turns(q.y, rho),
        scene_direction(ellipsoid, scaled(around, ellipsoid.semi)),
        scene_direction(ellipsoid, scaled(upwards, ellipsoid.semi)),
    )


def scaled(v: Vec, scale: Vec) -> Vec:
    """The vector v, scaled by its own factor along each axis."""
    return Vec(v.x * scale.x, v.y * scale.y, v.z * scale.z)


def boundary(ellipsoid: Any, point: Vec) -> Boundary:
    """(x / a)^2 + (y / b)^2 + (z / c)^2 - 1 along its own axes, for the semi-axes a, b and c."""
    x, y, z = own_coordinates(ellipsoid.axis, ellipsoid.roll, point - ellipsoid.centre)
    x, y, z = 2 * x / ellipsoid.sizes.x, 2 * y / ellipsoid.sizes.y, 2 * z / ellipsoid.sizes.z
    return Boundary((x * x + y * y + z * z - 1.0,))
