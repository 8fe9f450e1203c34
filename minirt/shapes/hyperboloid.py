"""Hyperboloid: `hy x,y,z ax,ay,az waist diameter height R,G,B`.

A solid hyperboloid of one sheet about the axis `ax,ay,az`, with a cap at both ends. `x,y,z` is its centre; it is
`waist` wide there and `diameter` wide at the ends, `height` apart. The waist may be as wide as the ends: a cylinder.
A picture lies once around the side, with its middle towards -z on an upright hyperboloid, and once on the square around
each cap.

    hy 0,0,20  0,1,0  2  4  6  180,140,220    a cooling tower six units high
"""

from __future__ import annotations

from math import sqrt as root
from typing import Any, NamedTuple

from minirt.fields import Colour, Direction, Length, Point, Triple, declare, spelled
from minirt.lanes import Number, Vec, copysign, fabs, inverse_root, maximum, rarely, splat, sqrt, unit, where
from minirt.records import record
from minirt.shapes import quadrics
from minirt.shapes.boundary import Boundary, along_and_off_axis
from minirt.shapes.compensated import divided, minus, pair, position_error, square_of
from minirt.shapes.frames import capped_mapping, in_scene, own_direction, own_point
from minirt.shapes.shape import Ball, Capped, Hit, Position, point_along


@record()
class Hyperboloid(Capped):
    """A line `hy` of a scene file."""

    code, title, plural, revolved = "hy", "hyperboloid", "hyperboloids", True
    centre: Triple = declare(Point, "centre, half-way up")
    axis: Triple = declare(Direction, "axis")
    waist: float = declare(Length, "diameter at the centre, at most that of the ends", initial=0.5)
    diameter: float = declare(Length, "diameter of the ends")
    height: float = declare(Length, "height")
    colour: Triple = declare(Colour, "colour")

    def conflict(self) -> tuple[str, str] | None:
        if self.waist <= self.diameter:
            return None
        return "waist", f"must be at most the diameter, {spelled(self.diameter)}, got {spelled(self.waist)}"

    def pack(self) -> PackedHyperboloid:
        thinner, thicker = self.diameter - self.waist, self.diameter + self.waist
        slope = root(thinner / self.height) * root(thicker / self.height)
        sizes = self.waist / 2, slope, self.diameter / 2, self.height / 2
        return PackedHyperboloid(Position(Vec(*self.centre)), *self.frame(), *sizes)

    def balls(self) -> tuple[Ball, ...]:
        up = self.height / 2
        return tuple((point_along(self.centre, self.axis, way), self.diameter / 2) for way in (-up, up))


class PackedHyperboloid(NamedTuple):
    """Packed form of a hyperboloid: its own frame, in which it stands upright at the origin."""

    centre: Position
    u: Vec
    v: Vec
    w: Vec  # the axis
    waist: float  # its radius
    slope: float  # x^2 + y^2 = waist^2 + slope^2 z^2 on the side
    radius: float  # of the ends
    half: float  # of the height


def intersect(hyperboloid: PackedHyperboloid, origin: Vec, direction: Vec, limit: Number | None = None) -> Hit:
    """Whether a ray meets the hyperboloid, and the least t > 0 at which it does; `limit` as in `minirt.shapes.shape`.

    x^2 + y^2 <= waist^2 + slope^2 z^2 holds for an interval of t if the ray is flatter than the asymptotic cone, and
    outside of an interval, perhaps empty, if it is steeper. Cut to the heights between the caps that leaves up to two
    intervals in the solid; the first end of one with t > 0 is the hit. On the side a t^2 + 2 b t + c = 0: with b for t
    from the origin, with b_q and c for t from `start`, where q is.
    """
    p, d = own_point(hyperboloid, origin), own_direction(hyperboloid, direction)
    rise = hyperboloid.slope * d.z
    a = d.x * d.x + d.y * d.y - rise * rise
    reach = hyperboloid.slope * p.z
    b = p.x * d.x + p.y * d.y - reach * rise
    squared_waist = hyperboloid.waist * hyperboloid.waist
    per_a = 1.0 / a
    first, last = quadrics.slab(p.z, d.z, -hyperboloid.half, hyperboloid.half)
    # From here on t is counted from the plane of the waist or, for a flat ray, from the deepest point in the solid.
    steep = a < quadrics.PARALLEL * (rise * rise)
    start = where(steep, -p.z * (1.0 / d.z), quadrics.clamped_minimum(per_a, b, first, last))
    q = p + start * d
    reach_q = hyperboloid.slope * q.z
    b_q = q.x * d.x + q.y * d.y - reach_q * rise
    c = q.x * q.x + q.y * q.y - reach_q * reach_q - squared_waist
    span = quadrics.Span(a, *quadrics.negative_interval(a, per_a, b_q, c, start), first, last, fabs(d.z) + 1.0)
    if limit is None:  # the ray may start on the surface
        squared = reach * reach + squared_waist
        level = p.x * p.x + p.y * p.y - squared
        over = fabs(p.z) - hyperboloid.half
        size = hyperboloid.waist + (1.0 + hyperboloid.slope) * hyperboloid.half
        off = (1.0 + hyperboloid.slope) * position_error(origin, p)  # along the radius
        close = quadrics.starts_close(a, b, level, squared, over, size, p.z * d.z, off)
        if rarely(close):
            narrow, half = square_of(hyperboloid.waist, a), splat(hyperboloid.half, a)
            widening = minus(square_of(hyperboloid.radius, a), narrow)
            slope, zero = divided(divided(widening, half), half), pair(0.0, 0.0, a)
            side = narrow, zero, slope
            exact = quadrics.exact_span(hyperboloid.centre, hyperboloid.w, origin, direction, side, -half, half)
            span = where(close, exact, span)
    return quadrics.first_overlap_of_steep(span)


def surface(hyperboloid: PackedHyperboloid, point: Vec) -> tuple[Vec, Vec]:
    """`point` moved onto the side or a cap, whichever is nearer, and the outward normal there.

    It moves to the side along the axis where that is flatter than 45 degrees, and across the axis where it is steeper:
    exactly, and hardly farther than the nearest point.
    """
    p = own_point(hyperboloid, point)
    rho = sqrt(p.x * p.x + p.y * p.y)
    reach = hyperboloid.slope * p.z
    fall = hyperboloid.slope * reach  # rho and -fall: gradient of the side's function, across and along the axis
    steep = rho >= fabs(fall)
    radius = sqrt(hyperboloid.waist * hyperboloid.waist + reach * reach)
    above = 0.5 * (rho - radius) * (rho + radius) * inverse_root(rho * rho + fall * fall)  # to first order
    over = fabs(p.z) - hyperboloid.half
    side = above >= over
    out = where(steep, radius / rho, 1.0)
    rise = sqrt(maximum((rho - hyperboloid.waist) * (rho + hyperboloid.waist), 0.0)) / hyperboloid.slope
    foot = Vec(out * p.x, out * p.y, where(steep, p.z, copysign(rise, p.z)))
    flat = splat(0.0, over)
    cap = Vec(flat, flat, copysign(1.0, p.z))
    falling = hyperboloid.slope * hyperboloid.slope * foot.z
    normal = where(side, unit(Vec(foot.x, foot.y, -falling)), cap)
    on = where(side, foot, p - over * cap)
    return in_scene(hyperboloid, on, normal)


def mapping(hyperboloid: PackedHyperboloid, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """Angle around the side as u, height as v."""
    p, out = own_point(hyperboloid, point), own_direction(hyperboloid, normal)
    tall = 2.0 * hyperboloid.half
    rho = sqrt(p.x * p.x + p.y * p.y)
    per_rho = 1.0 / where(rho == 0.0, 1.0, rho)  # a waist of almost no width has points on the axis
    widening = hyperboloid.slope * (hyperboloid.slope * p.z * per_rho)  # by height
    rise = tall * Vec(widening * (p.x * per_rho), widening * (p.y * per_rho), 1.0)
    return capped_mapping(hyperboloid, p, out, 0.5 + p.z / tall, rise, hyperboloid.radius)


def boundary(hyperboloid: Any, point: Vec) -> Boundary:
    """x^2 + y^2 - waist^2 - slope^2 z^2 on the side; distance from the caps."""
    height, rho = along_and_off_axis(hyperboloid.axis, point - hyperboloid.centre)
    waist, widest = hyperboloid.waist, hyperboloid.diameter
    slope = (widest - waist) * (widest + waist) / (hyperboloid.height * hyperboloid.height)  # squared
    side = rho * rho - waist * waist / 4 - slope * height * height
    return Boundary((side, abs(height) - hyperboloid.height / 2))
