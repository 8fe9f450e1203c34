"""Cone: `co x,y,z ax,ay,az diameter height R,G,B`.

A solid cone with a cap on its base. `x,y,z` is the apex; the axis `ax,ay,az` runs from there to the base, which has
this `diameter` and lies at the distance `height`. A picture lies once around the side, its upper edge at the apex, and
once on the square around the base; on a cone that stands upright its middle is towards -z.

    co 0,3,20  0,-1,0  2  3  240,160,40    a tent three units high that stands on y = 0
"""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.fields import Colour, Direction, Length, Point, Triple, declare
from minirt.lanes import (
    Mask,
    Number,
    Vec,
    any,
    copysign,
    fabs,
    inverse_root,
    max_norm,
    maximum,
    minimum,
    rarely,
    splat,
    sqrt,
    unit_roundoff,
    where,
)
from minirt.records import record
from minirt.shapes import quadrics
from minirt.shapes.boundary import Boundary, along_and_off_axis, hypotenuse
from minirt.shapes.compensated import axis_low, minus, quotient_low, times, value
from minirt.shapes.frames import in_scene, own_direction, own_point, revolved_mapping, to_basis
from minirt.shapes.shape import Ball, Capped, Position, point_along

PARALLEL = 2.0**-6  # share of a steepness by which that of a ray beside a generator differs
# Unit roundoffs of the size of a cone: within that distance of the axis a ray starts close to the apex, wherever its
# side is. In a shell of 64 roundings around the side the square of the distance exceeds that of the side by much of
# itself.
SHELL = 2.0**13
BLUNT = 2.0**-14  # share of the height within which the apex is blunt; its square for rays beside generators
BLUR = 16.0  # unit roundoffs of the distance from the apex by which the cone is thinner there


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
        slope_low = quotient_low((self.diameter,), (2.0, self.height), slope)
        sizes = slope, slope_low, self.height
        return PackedCone(Position(Vec(*self.apex)), *self.frame(), axis_low(self.axis), *sizes)

    def balls(self) -> tuple[Ball, ...]:
        return (self.apex, 0.0), (point_along(self.apex, self.axis, self.height), self.diameter / 2)


class PackedCone(NamedTuple):
    """Packed form of a cone: its own frame, in which the apex is the origin and the base lies above it."""

    centre: Position  # the apex
    u: Vec
    v: Vec
    w: Vec  # the axis
    w_low: Vec  # what the rounded axis lacks
    slope: float  # radius by height
    slope_low: float  # what the rounded slope lacks
    height: float


def intersect(cone: PackedCone, origin: Vec, direction: Vec, anywhere: bool | None = True) -> tuple[Mask, Number]:
    """Whether and where a ray meets the cone.

    x^2 + y^2 <= slope^2 z^2 holds in two nappes, the cone and its mirror image. A ray that is flatter than the side is
    in one of them for an interval of t. A steeper ray, which crosses the plane between them, is in both, except for an
    interval around that plane. The result is cut to the heights between apex and base: as with the cylinder there is no
    crack at the rim, and none at the apex. A steep ray meets the double cone in every case; for one along the axis
    rounding may deny that, and the whole interval between apex and base is left. For a ray beside a generator t is
    counted from the height of the apex: its deepest point is known badly, and where it passes the apex closely its
    distance from there counts.
    """
    p, d = own_point(cone, origin), own_direction(cone, direction)
    rise = cone.slope * d.z
    steepness = rise * rise
    a = d.x * d.x + d.y * d.y - steepness
    steep = a < 0.0
    reach = cone.slope * p.z
    b = p.x * d.x + p.y * d.y - reach * rise
    per_a, per_height = 1.0 / a, 1.0 / d.z
    tip = -p.z * per_height
    base = (cone.height - p.z) * per_height
    first, last = minimum(tip, base), maximum(tip, base)
    parallel = fabs(a) <= PARALLEL * steepness
    start = quadrics.clamped_minimum(per_a, b, first, last)
    if rarely(parallel):
        start = where(parallel, tip, start)
    q = p + start * d
    reach_q = cone.slope * q.z
    half_b = q.x * d.x + q.y * d.y - reach_q * rise
    product = c = q.x * q.x + q.y * q.y - reach_q * reach_q
    if anywhere is not None:
        squared, half = reach * reach, 0.5 * cone.height
        level = p.x * p.x + p.y * p.y - squared
        over, size = fabs(p.z - half) - half, (1.0 + cone.slope) * cone.height
        shell = SHELL * unit_roundoff(a) * (1.0 + cone.slope) * size
        close = quadrics.starts_close(a, b, level, squared + shell * shell, over, size, (p.z - half) * d.z)
        if rarely(close):
            low, high, start, half_b, c, product = close_start(
                cone, origin, p, d, close, parallel, a, per_a, b, level, over, per_height, start, half_b, c
            )
            first, last = where(close, low, first), where(close, high, last)
    met, below, above = quadrics.negative_interval(a, per_a, half_b, c, product)
    hit = met | steep
    t = start
    if any(hit):
        rising = d.z > 0.0  # a steep ray that rises leaves the other nappe and enters this one, up to the base
        near = where(steep & ~rising, first, maximum(start + below, first))
        far = where(steep & rising, last, minimum(start + above, last))
        t = where(near > 0.0, near, far)
        hit = hit & (near <= far) & (t > 0.0)
    return hit, t


def surface(cone: PackedCone, point: Vec) -> tuple[Vec, Vec]:
    """`point` moved onto the side or the base, whichever is nearer, and the outward normal there.

    At the apex the normal is opposite to the axis.
    """
    p = own_point(cone, point)
    rho = sqrt(p.x * p.x + p.y * p.y)
    cosine = inverse_root(splat(1.0, rho) + cone.slope * cone.slope)  # of the angle between axis and side
    sine = cone.slope * cosine
    off = rho * cosine - p.z * sine
    on_side = off >= p.z - cone.height
    flat = splat(0.0, rho)
    on_axis = rho == 0.0
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
    return revolved_mapping(u, v, w, p, out.z > -0.5, 1.0 + p.z / cone.height, rise, cone.slope * cone.height)


def boundary(cone: Any, point: Vec) -> Boundary:
    """Distances from the side and from the base; the side ends at the apex."""
    height, rho = along_and_off_axis(cone.axis, point - cone.apex)
    radius = cone.diameter / 2
    side = (rho * cone.height - height * radius) / hypotenuse(radius, cone.height)
    return Boundary((side, height - cone.height), (-height,))


# Rays that start on a cone, or close to it on the scale of the cone: their quadratic equation, without cancellation.
# Three places need care, besides that of all quadrics (`minirt.shapes.quadrics`).
#
# A ray beside a generator. From a start at the side nearly everything cancels in a and b, and in the farther end, about
# -2 b / a. From the height of the apex that end is exact, and b follows from both ends, of which the nearer one is
# c / a by the farther one. If both ends are about as far away the ray passes the apex so closely that the discriminant
# cancels, and if the nearer end is about as far away as the apex b is known too badly: then t is counted from the
# height of the apex alone.
#
# The neighbourhood of the apex. Rounding decides there whether a ray touches the side, and one that starts outside must
# not hit where it starts: it passes the side unless it meets a cone which is thinner by some roundings of the distance.
#
# A start within its own rounding of both ends, as of the apex, is on both: both are at t = 0 for a ray that is steeper
# than the side, and any other ray touches the side there and misses. So does one from the side towards the apex with
# a = 0: the level, which is linear then, is 0 at its start and not negative at the height of the apex, hence nowhere
# between; rounding alone may deny that.


def close_start(
    cone: Any,
    origin: Vec,
    p: Vec,
    d: Vec,
    close: Mask,
    parallel: Mask,
    a: Number,
    per_a: Number,
    b: Number,
    level: Number,
    over: Number,
    per_height: Number,
    start: Number,
    tip_b: Number,
    tip_c: Number,
) -> tuple[Number, Number, Number, Number, Number, Number]:
    """Return for `close` rays t at the first and at the last cap, and where t is counted from; there b, c and product.

    `parallel` rays are beside a generator: `start` is the height of the apex, where b and c are `tip_b` and `tip_c`.
    """
    reach, rise = cone.slope * p.z, cone.slope * d.z
    squared = reach * reach
    height, power = quadrics.axial(cone, origin, a)
    side = times((splat(cone.slope, a), splat(cone.slope_low, a)), height)  # its distance from the axis
    exact_level = value(minus(power, times(side, side)))
    slope = sqrt(squared * (1.0 + cone.slope * cone.slope))
    away, position = max_norm(p), quadrics.position_error(origin, p)
    on_apex = close & (away <= position)
    error = where(on_apex, position, quadrics.error_of_start(origin, p, level, slope, over))
    rounding = 2.0 * slope * error
    first, last = quadrics.between_caps(height, 0.0, cone.height, per_height, error)
    clear = quadrics.zero_within(exact_level, minimum(rounding, BLUNT * squared))
    alike = fabs(a * clear) > 4.0 * PARALLEL * (b * b)  # both ends are about as far away
    distant = fabs(clear) > PARALLEL * fabs(b) * away  # the nearer end is about as far away as the apex, or farther
    beside = close & quadrics.beside_side(level, squared, over, 0.5 * cone.height) & ~(parallel & (alike | distant))
    far = farther_end(a, per_a, start, tip_b, tip_c)
    start = where(beside, 0.0, where(close & ~parallel, quadrics.clamped_minimum(per_a, b, first, last), start))
    q = p + start * d
    reach_q = cone.slope * where(beside, height[0], q.z)
    half_b = q.x * d.x + q.y * d.y - reach_q * rise
    known = beside & parallel & (fabs(clear) < PARALLEL * fabs(a) * far * far) & (fabs(far) > error)
    half_b = where(known, -0.5 * (a * far + exact_level / far), half_b)
    c = where(beside, exact_level, q.x * q.x + q.y * q.y - reach_q * reach_q)
    on_side = beside & (fabs(c) <= rounding)
    product = where(on_side, 0.0, c)
    blunt = close & (away <= where(parallel, BLUNT * BLUNT, BLUNT) * cone.height)
    blur = where(blunt, BLUR * unit_roundoff(a) * (1.0 + cone.slope) * away, 0.0)
    c = c + blur * (2.0 * fabs(where(parallel, reach, reach_q)) + blur)
    half_b = quadrics.zero_within(half_b, maximum(blur * fabs(rise), where(on_side, fabs(a) * error, 0.0)))
    on_both = on_apex | (on_side & ((half_b == 0.0) | ((a == 0.0) & (d.z < 0.0))))
    start, half_b = where(on_apex, 0.0, start), where(on_both, 0.0, half_b)
    return first, last, start, half_b, where(on_both, where(a < 0.0, 0.0, 1.0), c), where(on_both, 0.0, product)


def farther_end(a: Number, per_a: Number, tip: Number, b: Number, c: Number) -> Number:
    """Return the root of a ray's quadratic equation that is farther from its start, 0 where it has none.

    t is counted from the start, and b and c are those at `tip`.
    """
    q = -(b + copysign(sqrt(b * b - a * c), b))
    one, other = tip + q * per_a, tip + c / q
    return where(fabs(q) > 0.0, where(fabs(one) > fabs(other), one, other), 0.0)
