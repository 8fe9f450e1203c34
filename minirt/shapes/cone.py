"""Cone: `co x,y,z ax,ay,az diameter height R,G,B`.

A solid cone with a cap on its base. `x,y,z` is the apex; the axis `ax,ay,az` runs from there to the base, which has
this `diameter` and lies at the distance `height`. A picture lies once around the side, its upper edge at the apex, and
once on the square around the base; on a cone that stands upright its middle is towards -z.

    co 0,3,20  0,-1,0  2  3  240,160,40    a tent three units high that stands on y = 0
"""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.fields import Colour, Direction, Length, Point, Triple, declare
from minirt.lanes import Number, Vec, fabs, inverse_root, rarely, splat, sqrt, where
from minirt.records import record
from minirt.shapes import quadrics
from minirt.shapes.boundary import Boundary, along_and_off_axis, hypotenuse
from minirt.shapes.compensated import divided, pair, position_error, times
from minirt.shapes.frames import in_scene, own_direction, own_point, revolved_mapping, to_basis
from minirt.shapes.shape import Ball, Capped, Hit, Position, point_along


@record()
class Cone(Capped):
    """A line `co` of a scene file."""

    code, title, plural, aliases, revolved = "co", "cone", "cones", ("cn", "cone"), True
    apex: Triple = declare(Point, "apex")
    axis: Triple = declare(Direction, "axis, from the apex to the base", initial=(0.0, -1.0, 0.0))
    diameter: float = declare(Length, "diameter of the base")
    height: float = declare(Length, "height")
    colour: Triple = declare(Colour, "colour")

    def pack(self) -> PackedCone:
        slope = self.diameter / 2 / self.height
        return PackedCone(Position(Vec(*self.apex)), *self.frame(), slope, self.diameter / 2, self.height)

    def balls(self) -> tuple[Ball, ...]:
        return (self.apex, 0.0), (point_along(self.apex, self.axis, self.height), self.diameter / 2)


class PackedCone(NamedTuple):
    """Packed form of a cone: its own frame, in which the apex is the origin and the base lies above it."""

    centre: Position  # the apex
    u: Vec
    v: Vec
    w: Vec  # the axis
    slope: float  # radius by height
    radius: float  # of the base
    height: float


def intersect(cone: PackedCone, origin: Vec, direction: Vec, limit: Number | None = None) -> Hit:
    """Whether a ray meets the cone, and the least t > 0 at which it does; `limit` as in `minirt.shapes.shape`.

    x^2 + y^2 <= slope^2 z^2 holds in two nappes, the cone and its mirror image. A ray that is flatter than the side is
    in one of them for an interval of t. A steeper ray, which crosses the plane between them, is in both, except for an
    interval around that plane. The result is cut to the heights between apex and base: as with the cylinder there is no
    crack at the rim, and none at the apex. A ray that is steeper, or hardly flatter, counts t from the plane between
    the nappes: its deepest point is known badly, and from there a hit beside the apex would be known as badly as one at
    the base.
    """
    p, d = own_point(cone, origin), own_direction(cone, direction)
    # On the side a t^2 + 2 b t + c = 0: with b for t from the origin, with b_q and c for t from `start`, where q is.
    rise = cone.slope * d.z
    steepness = rise * rise
    a = d.x * d.x + d.y * d.y - steepness
    reach = cone.slope * p.z
    b = p.x * d.x + p.y * d.y - reach * rise
    per_a = 1.0 / a
    first, last = quadrics.slab(p.z, d.z, 0.0, cone.height)
    steep = a < quadrics.PARALLEL * steepness
    start = where(steep, -p.z * (1.0 / d.z), quadrics.clamped_minimum(per_a, b, first, last))
    q = p + start * d
    reach_q = cone.slope * q.z
    b_q = q.x * d.x + q.y * d.y - reach_q * rise
    c = q.x * q.x + q.y * q.y - reach_q * reach_q
    pace = fabs(d.z) + 1.0 / (1.0 + cone.slope)
    span = quadrics.Span(a, *quadrics.negative_interval(a, per_a, b_q, c, start), first, last, pace)
    if limit is None:  # the ray may start on the surface
        squared, half = reach * reach, 0.5 * cone.height
        level = p.x * p.x + p.y * p.y - squared
        over, size = fabs(p.z - half) - half, (1.0 + cone.slope) * cone.height
        off = (1.0 + cone.slope) * position_error(origin, p)  # along the radius
        close = quadrics.starts_close(a, b, level, squared, over, size, (p.z - half) * d.z, off)
        if rarely(close):
            slope = divided(pair(cone.radius, 0.0, a), splat(cone.height, a))
            zero = pair(0.0, 0.0, a)
            side = zero, zero, times(slope, slope)
            exact = quadrics.exact_span(cone.centre, cone.w, origin, direction, side, zero[0], cone.height)
            span = where(close, exact, span)
    return quadrics.first_overlap_of_steep(span)


def surface(cone: PackedCone, point: Vec) -> tuple[Vec, Vec]:
    """`point` moved onto the side or the base, whichever is nearer, and the outward normal there.

    A point on the axis that is nearer to the apex than to the base moves to the apex, where the normal is opposite to
    the axis.
    """
    p = own_point(cone, point)
    rho = sqrt(p.x * p.x + p.y * p.y)
    cosine = inverse_root(splat(1.0, rho) + cone.slope * cone.slope)  # of the angle between axis and side
    sine = cone.slope * cosine
    on_axis = rho == 0.0
    off = where(on_axis, -p.z, rho * cosine - p.z * sine)
    on_side = off >= p.z - cone.height
    flat = splat(0.0, rho)
    per_rho = where(on_axis, 0.0, 1.0 / rho)
    aside = where(on_side, cosine, flat)
    up = where(on_side, where(on_axis, -1.0, -sine), 1.0)
    out = Vec(p.x * per_rho * aside, p.y * per_rho * aside, up)
    on = p - where(on_side, off, p.z - cone.height) * out
    return in_scene(cone, on, out)


def mapping(cone: PackedCone, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """Angle around the side as u, and v from the base up to the apex: in a frame that has the apex above."""
    u, v, w = cone.u, -cone.v, -cone.w
    p = to_basis(u, v, w, point - cone.centre)
    out = to_basis(u, v, w, normal)
    narrowing = -cone.slope * sqrt(1.0 + cone.slope * cone.slope)  # by height, along out.x and out.y
    rise = cone.height * Vec(narrowing * out.x, narrowing * out.y, 1.0)
    return revolved_mapping(u, v, w, p, out.z > -0.5, 1.0 + p.z / cone.height, rise, cone.radius)


def boundary(cone: Any, point: Vec) -> Boundary:
    """Distances from the side and from the base; the side ends at the apex."""
    height, rho = along_and_off_axis(cone.axis, point - cone.apex)
    radius = cone.diameter / 2
    side = (rho * cone.height - height * radius) / hypotenuse(radius, cone.height)
    return Boundary((side, height - cone.height), (-height,))
