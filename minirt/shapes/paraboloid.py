"""Paraboloid: `pa x,y,z ax,ay,az diameter height R,G,B`.

A solid paraboloid of revolution with a cap. `x,y,z` is the vertex; it opens along the axis `ax,ay,az` and has its
`diameter` at the distance `height`, where the cap closes it. A picture lies once around the side, with its middle
towards -z on an upright paraboloid and upwards in equal steps of the distance from the axis, and once on the square
around the cap.

    pa 0,0,20  0,1,0  4  3  120,200,160    a bowl, filled to the brim, whose rim is three units above its bottom
"""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.fields import Colour, Direction, Length, Point, Triple, declare
from minirt.lanes import Number, Vec, fabs, inverse_root, maximum, rarely, splat, sqrt, unit, where
from minirt.records import record
from minirt.shapes import quadrics
from minirt.shapes.boundary import Boundary, along_and_off_axis
from minirt.shapes.compensated import divided, pair, position_error, square_of
from minirt.shapes.frames import capped_mapping, in_scene, own_direction, own_point
from minirt.shapes.shape import Axial, Ball, Bounds, Hit, Position, bounds_of_disc, point_along, union_of_bounds


@record()
class Paraboloid(Axial):
    """A line `pa` of a scene file."""

    code, title, plural, revolved = "pa", "paraboloid", "paraboloids", True
    vertex: Triple = declare(Point, "vertex")
    axis: Triple = declare(Direction, "axis, along which it opens")
    diameter: float = declare(Length, "diameter of the rim")
    height: float = declare(Length, "height")
    colour: Triple = declare(Colour, "colour")

    def pack(self) -> PackedParaboloid:
        radius = self.diameter / 2
        focal = radius * (radius / self.height) / 2
        return PackedParaboloid(Position(Vec(*self.vertex)), *self.frame(), focal, radius, self.height)

    def balls(self) -> tuple[Ball, ...]:
        # In directions below its vertex it reaches less far than a ball of half the radius of its rim.
        return (self.vertex, self.diameter / 4), (point_along(self.vertex, self.axis, self.height), self.diameter / 2)

    def bounds(self) -> Bounds:
        rim = bounds_of_disc(point_along(self.vertex, self.axis, self.height), self.axis, self.diameter / 2)
        _, sines = bounds_of_disc((0.0, 0.0, 0.0), self.axis, 1.0)  # of the angles between the axis and x, y and z
        bulges = []
        for i, (w, s) in enumerate(zip(self.axis, sines, strict=True)):
            # The outermost point along x, y or z lies below the rim if the paraboloid is tilted far enough.
            radius, fall = self.diameter / 2 * s, 2 * self.height * abs(w)
            if radius < fall:  # so `fall` is not 0, as it may be where the height is subnormal
                bulge = list(self.vertex)
                bulge[i] -= self.diameter / 4 * s * (radius / fall) * (1 if w > 0 else -1)
                bulges.append((bulge[0], bulge[1], bulge[2]))
        return union_of_bounds((self.vertex, self.vertex), rim, *((bulge, bulge) for bulge in bulges))


class PackedParaboloid(NamedTuple):
    """Packed form of a paraboloid: its own frame, in which the vertex is the origin and the cap lies above it."""

    centre: Position  # the vertex
    u: Vec
    v: Vec
    w: Vec  # the axis
    focal: float  # x^2 + y^2 = 2 focal z on the side: the radius of curvature of the vertex
    radius: float  # of the rim
    height: float


def intersect(paraboloid: PackedParaboloid, origin: Vec, direction: Vec, limit: Number | None = None) -> Hit:
    """Whether a ray meets the paraboloid, and the least t > 0 at which it does; `limit` as in `minirt.shapes.shape`.

    As with the cylinder the ray is inside for an interval of t, here that of x^2 + y^2 <= 2 focal z, cut to the heights
    below the cap. For a ray along the axis one end of the interval is infinite, and the other is exact. On the side
    a t^2 + 2 b t + c = 0: with b for t from the origin, with b_q and c for t from `start`, where q is.
    """
    p, d = own_point(paraboloid, origin), own_direction(paraboloid, direction)
    a = d.x * d.x + d.y * d.y
    slant = paraboloid.focal * d.z
    b = p.x * d.x + p.y * d.y - slant
    per_a = 1.0 / a
    first, last = quadrics.slab(p.z, d.z, 0.0, paraboloid.height)
    start = quadrics.clamped_minimum(per_a, b, first, last)
    q = p + start * d
    b_q = q.x * d.x + q.y * d.y - slant
    c = q.x * q.x + q.y * q.y - 2.0 * paraboloid.focal * q.z
    pace = fabs(d.z) + paraboloid.radius / (paraboloid.radius + paraboloid.focal)
    span = quadrics.Span(a, *quadrics.negative_interval(a, per_a, b_q, c, start), first, last, pace)
    if limit is None:  # the ray may start on the surface
        squared_rho = p.x * p.x + p.y * p.y
        squared = squared_rho + paraboloid.focal * paraboloid.focal
        level = squared_rho - 2.0 * paraboloid.focal * p.z
        half = 0.5 * paraboloid.height
        over, size = fabs(p.z - half) - half, paraboloid.focal + paraboloid.height
        close = quadrics.starts_close(a, b, level, squared, over, size, (p.z - half) * d.z, position_error(origin, p))
        if rarely(close):
            zero, height = pair(0.0, 0.0, a), paraboloid.height
            side = zero, divided(square_of(paraboloid.radius, a), splat(2.0 * height, a)), zero
            exact = quadrics.exact_span(paraboloid.centre, paraboloid.w, origin, direction, side, zero[0], height)
            span = where(close, exact, span)
    return quadrics.first_overlap(span)


def surface(paraboloid: PackedParaboloid, point: Vec) -> tuple[Vec, Vec]:
    """`point` moved onto the side or the cap, whichever is nearer, and the outward normal there.

    It moves to the side along the axis where that is flatter than 45 degrees, and across the axis where it is steeper:
    exactly, and hardly farther than the nearest point.
    """
    p = own_point(paraboloid, point)
    squared = p.x * p.x + p.y * p.y
    steep = squared > paraboloid.focal * paraboloid.focal
    within = 2.0 * paraboloid.focal * p.z  # the square of the radius at that height
    above = 0.5 * (squared - within) * inverse_root(squared + paraboloid.focal * paraboloid.focal)  # to first order
    over = p.z - paraboloid.height
    side = above >= over
    out = where(steep, sqrt(maximum(within, 0.0) / squared), 1.0)
    foot = Vec(out * p.x, out * p.y, where(steep, p.z, squared * (0.5 / paraboloid.focal)))
    flat = splat(0.0, over)
    cap = Vec(flat, flat, flat + 1.0)
    normal = where(side, unit(Vec(foot.x, foot.y, flat - paraboloid.focal)), cap)
    on = where(side, foot, p - over * cap)
    return in_scene(paraboloid, on, normal)


def mapping(paraboloid: PackedParaboloid, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """Angle around the side as u, distance from the axis as v, so that the vertex is not stretched without end.

    At the vertex the tangents are zero.
    """
    p, out = own_point(paraboloid, point), own_direction(paraboloid, normal)
    rho = sqrt(p.x * p.x + p.y * p.y)
    per_rho = 1.0 / where(rho == 0.0, 1.0, rho)
    radius = paraboloid.radius
    rise = radius * Vec(p.x * per_rho, p.y * per_rho, rho / paraboloid.focal)
    return capped_mapping(paraboloid, p, out, rho / radius, rise, radius)


def boundary(paraboloid: Any, point: Vec) -> Boundary:
    """x^2 + y^2 - radius^2 z / height on the side; distance from the cap."""
    height, rho = along_and_off_axis(paraboloid.axis, point - paraboloid.vertex)
    radius = paraboloid.diameter / 2
    return Boundary((rho * rho - radius * radius / paraboloid.height * height, height - paraboloid.height))
