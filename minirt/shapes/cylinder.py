"""Cylinder: `cy x,y,z ax,ay,az diameter height R,G,B`.

A solid cylinder with both caps about the axis `ax,ay,az`; `x,y,z` is its centre, half-way up. A picture lies once
around the side, with its middle towards -z on an upright cylinder, and once on the square around each cap.

    cy 0,0,20  0,1,0  2  5  255,200,0    an upright column, from y = -2.5 to y = 2.5
"""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.fields import Colour, Direction, Length, Point, Triple, declare
from minirt.lanes import Number, Vec, copysign, fabs, rarely, splat, sqrt, where
from minirt.records import record
from minirt.shapes import quadrics
from minirt.shapes.boundary import Boundary, along_and_off_axis
from minirt.shapes.compensated import pair, position_error, square_of
from minirt.shapes.frames import capped_mapping, in_scene, own_direction, own_point
from minirt.shapes.shape import Ball, Capped, Hit, Position, point_along


@record()
class Cylinder(Capped):
    """A line `cy` of a scene file."""

    code, title, plural, revolved, convex = "cy", "cylinder", "cylinders", True, True
    centre: Triple = declare(Point, "centre, half-way up")
    axis: Triple = declare(Direction, "axis")
    diameter: float = declare(Length, "diameter")
    height: float = declare(Length, "height")
    colour: Triple = declare(Colour, "colour")

    def pack(self) -> PackedCylinder:
        sizes = self.diameter / 2, self.height / 2
        return PackedCylinder(Position(Vec(*self.centre)), *self.frame(), *sizes)

    def balls(self) -> tuple[Ball, ...]:
        up = self.height / 2
        return tuple((point_along(self.centre, self.axis, way), self.diameter / 2) for way in (up, -up))


class PackedCylinder(NamedTuple):
    """Packed form of a cylinder: its own frame, in which it stands upright at the origin."""

    centre: Position
    u: Vec
    v: Vec
    w: Vec  # the axis
    radius: float
    half: float  # of the height


def intersect(cylinder: PackedCylinder, origin: Vec, direction: Vec, limit: Number | None = None) -> Hit:
    """Whether a ray meets the cylinder, and the least t > 0 at which it does; `limit` as in `minirt.shapes.shape`.

    The ray is inside the infinite tube for one interval of t and between the planes of the caps for another; it is
    inside the cylinder where these overlap. There is no crack between cap and side, whatever the rounding.
    """
    p, d = own_point(cylinder, origin), own_direction(cylinder, direction)
    # On the side a t^2 + 2 b t + c = 0: with b for t from the origin, with b_q and c for t from `start`, where q is.
    a = d.x * d.x + d.y * d.y
    b = p.x * d.x + p.y * d.y
    squared = cylinder.radius * cylinder.radius
    per_a = 1.0 / a
    first, last = quadrics.slab(p.z, d.z, -cylinder.half, cylinder.half)
    start = quadrics.clamped_minimum(per_a, b, first, last)
    q = p + start * d
    b_q = q.x * d.x + q.y * d.y
    c = q.x * q.x + q.y * q.y - squared
    span = quadrics.Span(a, *quadrics.negative_interval(a, per_a, b_q, c, start), first, last, fabs(d.z) + 1.0)
    if limit is None:  # the ray may start on the surface
        level = p.x * p.x + p.y * p.y - squared
        over = fabs(p.z) - cylinder.half
        size = cylinder.radius + cylinder.half
        close = quadrics.starts_close(a, b, level, squared, over, size, p.z * d.z, position_error(origin, p))
        if rarely(close):
            zero, half = pair(0.0, 0.0, a), cylinder.half
            side = square_of(cylinder.radius, a), zero, zero
            exact = quadrics.exact_span(cylinder.centre, cylinder.w, origin, direction, side, -half, half)
            span = where(close, exact, span)
    return quadrics.first_overlap(span)


def surface(cylinder: PackedCylinder, point: Vec) -> tuple[Vec, Vec]:
    """`point` moved onto the side or the cap, whichever is nearer, and the outward normal there."""
    p = own_point(cylinder, point)
    rho = sqrt(p.x * p.x + p.y * p.y)
    up = copysign(1.0, p.z)
    side = rho - cylinder.radius >= fabs(p.z) - cylinder.half
    flat = splat(0.0, p.z)
    out = where(side, Vec(p.x, p.y, flat) / rho, Vec(flat, flat, up))
    on = where(side, Vec(out.x * cylinder.radius, out.y * cylinder.radius, p.z), Vec(p.x, p.y, up * cylinder.half))
    return in_scene(cylinder, on, out)


def mapping(cylinder: PackedCylinder, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """Angle around the side as u, height as v; on the caps the square around them."""
    p, out = own_point(cylinder, point), own_direction(cylinder, normal)
    tall = 2.0 * cylinder.half
    return capped_mapping(cylinder, p, out, 0.5 + p.z / tall, Vec(0.0, 0.0, tall), cylinder.radius)


def boundary(cylinder: Any, point: Vec) -> Boundary:
    """Distances from the side and from the caps."""
    height, rho = along_and_off_axis(cylinder.axis, point - cylinder.centre)
    return Boundary((rho - cylinder.diameter / 2, abs(height) - cylinder.height / 2))
