"""Capsule: `ca x,y,z ax,ay,az diameter height R,G,B`.

A made-up shape: all points within half the diameter of a straight line. The line is `height` long, lies along
`ax,ay,az`, and has `x,y,z` in its middle. A picture lies once around the axis, and from one tip to the other.

    ca 0,0,20  0,1,0  2  3  200,120,80    an upright capsule, from y = -2.5 to y = 2.5
"""

from __future__ import annotations

from math import pi
from typing import Any, NamedTuple

from minirt.fields import Colour, Direction, Length, Point, Triple, declare
from minirt.lanes import Number, Vec, copysign, dot, fabs, maximum, minimum, sqrt, unit, where
from minirt.records import record
from minirt.shapes.boundary import Boundary, along_and_off_axis, clamp, hypotenuse
from minirt.shapes.compensated import position_error
from minirt.shapes.frames import TWO_PI, angle_in_turns, in_scene, longitude, own_direction, own_point, scene_direction
from minirt.shapes.shape import Axial, Ball, Bounds, Hit, Position, bounds_of_points, point_along


@record()
class Capsule(Axial):
    """A line `ca` of a scene file."""

    code, title, plural, revolved = "ca", "capsule", "capsules", True
    centre: Triple = declare(Point, "centre, half-way up")
    axis: Triple = declare(Direction, "axis")
    diameter: float = declare(Length, "diameter")
    height: float = declare(Length, "height of the straight part")
    colour: Triple = declare(Colour, "colour")

    def pack(self) -> PackedCapsule:
        return PackedCapsule(Position(Vec(*self.centre)), *self.frame(), self.diameter / 2, self.height / 2)

    def balls(self) -> tuple[Ball, ...]:
        up = self.height / 2
        return tuple((point_along(self.centre, self.axis, way), self.diameter / 2) for way in (up, -up))

    def bounds(self) -> Bounds:
        corners = [tuple(x + way * r for x in centre) for centre, r in self.balls() for way in (-1, 1)]
        return bounds_of_points(*corners)  # type: ignore[arg-type]


class PackedCapsule(NamedTuple):
    """Packed form of a capsule: its own frame, in which it stands upright at the origin."""

    centre: Position
    u: Vec
    v: Vec
    w: Vec  # the axis
    radius: float
    half: float  # of the height


def intersect(capsule: PackedCapsule, origin: Vec, direction: Vec, limit: Number | None = None) -> Hit:
    """Whether and where a ray meets the capsule.

    The ray enters and leaves by the tube where it is between the ends of the line there, and by a ball otherwise. A
    ray that starts on the surface, within rounding, leaves at once or by the other side.
    """
    p, d = own_point(capsule, origin), own_direction(capsule, direction)
    enter, tube = crossing(capsule, p, d, -1.0)
    leave, _ = crossing(capsule, p, d, 1.0)
    out = outwards(capsule, p)
    rounding = position_error(origin, origin - capsule.centre)
    on = fabs(sqrt(dot(out, out)) - capsule.radius) <= rounding
    t = where((enter > 0.0) & ~on, enter, leave)
    return tube & (t > 0.0) & ~(on & (dot(out, d) >= 0.0)), t


def outwards(capsule: PackedCapsule, p: Vec) -> Vec:
    """The vector to a point, in the capsule's frame, from the nearest point of the line."""
    return Vec(p.x, p.y, p.z - minimum(maximum(p.z, -capsule.half), capsule.half))


def crossing(capsule: PackedCapsule, p: Vec, d: Vec, sign: float) -> tuple[Number, Any]:
    """Return where a ray enters (sign -1) or leaves (1), counted from the closest approach, and whether it does."""
    squared = capsule.radius * capsule.radius
    a = d.x * d.x + d.y * d.y
    steep = a < 1e-30
    start = where(steep, 0.0, -(p.x * d.x + p.y * d.y) / where(steep, 1.0, a))
    q = p + start * d
    chord = (squared - (q.x * q.x + q.y * q.y)) / where(steep, 1.0, a)
    t = start + sign * sqrt(maximum(chord, 0.0))
    z = where(steep, sign * d.z * 1e300, p.z + t * d.z)
    end = copysign(capsule.half, z)
    f = Vec(p.x, p.y, p.z - end)
    approach = -dot(f, d)
    g = f + approach * d
    room = squared - dot(g, g)
    ball = approach + sign * sqrt(maximum(room, 0.0))
    by_tube = fabs(z) <= capsule.half
    return where(by_tube, t, ball), (chord >= 0.0) & (by_tube | (room >= 0.0))


def surface(capsule: PackedCapsule, point: Vec) -> tuple[Vec, Vec]:
    """The nearest point of the surface, and the outward normal there."""
    p = own_point(capsule, point)
    away = outwards(capsule, p)
    out = unit(away)
    return in_scene(capsule, p - away + capsule.radius * out, out)


def mapping(capsule: PackedCapsule, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """Angle around the axis as u, length along the surface from tip to tip as v. At the tips the tangents are zero."""
    p, out = own_point(capsule, point), own_direction(capsule, normal)
    u, around = longitude(p)
    rho = sqrt(out.x * out.x + out.y * out.y)
    per_rho = 1.0 / where(rho == 0.0, 1.0, rho)
    length = pi * capsule.radius + 2.0 * capsule.half
    z = minimum(maximum(p.z, -capsule.half), capsule.half)
    v = 0.5 + (z + capsule.radius * TWO_PI * angle_in_turns(out.z, rho)) / length
    rise = length * Vec(-out.z * out.x * per_rho, -out.z * out.y * per_rho, rho)
    return u, v, scene_direction(capsule, around), scene_direction(capsule, rise)


def boundary(capsule: Any, point: Vec) -> Boundary:
    """Distance from the surface: the distance from the line, less the radius."""
    height, rho = along_and_off_axis(capsule.axis, point - capsule.centre)
    beyond = height - clamp(height, -0.5 * capsule.height, 0.5 * capsule.height)
    return Boundary((hypotenuse(rho, beyond) - capsule.diameter / 2,))
