"""Torus: `to x,y,z ax,ay,az diameter tube R,G,B`.

A solid ring about the axis `ax,ay,az`. `x,y,z` is its centre, `diameter` the diameter of the circle in the middle of
the tube, and `tube` that of the tube itself. A tube as wide as the diameter leaves no hole. A picture lies once around
the axis, with its middle towards -z on a ring that lies flat, and once around the tube, with its middle outermost.

    to 0,0,20  0,1,0  6  2  220,150,180    a ring that lies flat, eight units across and two units thick
"""

from __future__ import annotations

from math import cos, pi, sin
from typing import Any, NamedTuple

from minirt.fields import Colour, Direction, Length, Point, Triple, declare, spelled
from minirt.lanes import Mask, Number, Vec, any, dot, fabs, maximum, minimum, rarely, splat, sqrt, unit_roundoff, where
from minirt.records import record
from minirt.shapes.boundary import Boundary, along_and_off_axis, hypotenuse
from minirt.shapes.compensated import position_error
from minirt.shapes.frames import TWO_PI, angle_in_turns, in_scene, longitude, own_direction, own_point, scene_direction
from minirt.shapes.shape import Axial, Ball, Bounds, Hit, Position, bounds_of_disc, point_along

PAD = 16.0  # unit roundoffs of a torus' outer radius by which a computed height may be off, and more
STEPS = 100  # of Halley's or Newton's method at most; most roots take less than ten
CORNERS = 8  # of the polygon around the circle in the middle of the tube


@record()
class Torus(Axial):
    """A line `to` of a scene file."""

    code, title, plural, revolved = "to", "torus", "tori", True
    centre: Triple = declare(Point, "centre")
    axis: Triple = declare(Direction, "axis")
    diameter: float = declare(Length, "diameter of the circle in the middle of the tube")
    tube: float = declare(Length, "diameter of the tube, at most that of the circle", initial=0.4)
    colour: Triple = declare(Colour, "colour")

    def conflict(self) -> tuple[str, str] | None:
        if self.tube <= self.diameter:
            return None
        return "tube", f"must be at most the diameter, {spelled(self.diameter)}, got {spelled(self.tube)}"

    def pack(self) -> PackedTorus:
        return PackedTorus(Position(Vec(*self.centre)), *self.frame(), self.diameter / 2, self.tube / 2)

    def balls(self) -> tuple[Ball, ...]:
        u, v, _ = self.frame()
        reach = self.diameter / 2 / cos(pi / CORNERS)
        turns = [2 * pi * corner / CORNERS for corner in range(CORNERS)]
        directions = [cos(turn) * u + sin(turn) * v for turn in turns]
        return tuple((point_along(self.centre, (d.x, d.y, d.z), reach), self.tube / 2) for d in directions)

    def bounds(self) -> Bounds:
        r = self.tube / 2
        (a, b, c), (x, y, z) = bounds_of_disc(self.centre, self.axis, self.diameter / 2)
        return (a - r, b - r, c - r), (x + r, y + r, z + r)


class PackedTorus(NamedTuple):
    """Packed form of a torus: its own frame, in which it lies flat around the origin."""

    centre: Position
    u: Vec
    v: Vec
    w: Vec  # the axis
    ring: float  # radius of the circle in the middle of the tube
    tube: float  # radius of the tube


def intersect(torus: PackedTorus, origin: Vec, direction: Vec, limit: Number | None = None) -> Hit:
    """Whether a ray meets the torus, and the least t > 0 at which it does; `limit` as in `minirt.shapes.shape`.

    Between two turning points of the quartic along the ray the surface is crossed once if they lie on different sides
    of it, and not at all if they lie on the same side. So a root is searched only where there is one, and until it is
    exact; that of a shadow ray only if the ray ends between the same two points. The height of a point above the
    surface comes from its distance to the circle in the middle of the tube: that keeps all digits of a thin tube, which
    the polynomial loses. The ray is cut a little outside of the ball and the slab around the torus, clear of the places
    at which these touch it. A ray that starts on the surface, to rounding, starts on the side to which it goes: that of
    the next turning point that is not on the surface, too.
    """
    f = origin - torus.centre
    approach = -dot(f, direction)  # t is counted from the closest approach to the centre
    g = f + approach * direction
    pad = PAD * unit_roundoff(approach) * (torus.ring + torus.tube)
    rim = torus.ring + torus.tube + pad
    squared_half = rim * rim - dot(g, g)  # of half of the chord in the ball
    hit = squared_half >= 0.0
    t = approach
    if any(hit):
        p = own_direction(torus, g)
        d = own_direction(torus, direction)
        per_height = 1.0 / d.z
        level = torus.tube + pad
        bottom, top = (-level - p.z) * per_height, (level - p.z) * per_height
        half = sqrt(squared_half)
        enter = maximum(maximum(-half, minimum(bottom, top)), -approach)  # not before the ray's origin
        leave = minimum(half, maximum(bottom, top))
        hit = hit & (enter <= leave) & comes_near(torus, p, d, enter, leave, pad)
        if limit is not None:
            hit = hit & (approach + enter < limit)
        if any(hit):
            # The side of the surface at the start, and at the turning points between both ends.
            first, second, third = turning_points(torus, p, d, hit)
            first = minimum(maximum(first, enter), leave)
            second = minimum(maximum(second, enter), leave)
            third = minimum(maximum(third, enter), leave)
            start = splat(height(torus, own_direction(torus, f)), t)  # of primary rays it is one number
            height_1 = where(first > enter, height(torus, p + first * d), start)
            height_2 = where(second > first, height(torus, p + second * d), height_1)
            height_3 = where(third > second, height(torus, p + third * d), height_2)
            side_0, side_1, side_2, side_3 = side(start), side(height_1), side(height_2), side(height_3)
            error = position_error(origin, f) + pad
            on = fabs(start) <= error
            if rarely(on):  # from the last turning point back: a point on the surface takes the side of the next one
                side_3 = where(on & (fabs(height_3) <= error), 1.0, side_3)
                side_2 = where(on & (fabs(height_2) <= error), side_3, side_2)
                side_1 = where(on & (fabs(height_1) <= error), side_2, side_1)
                side_0 = where(on, side_1, side_0)
            # The first two neighbours on different sides enclose the first crossing. Behind the last turning point the
            # ray ends outside.
            by_1, by_2, by_3 = side_0 != side_1, side_1 != side_2, side_2 != side_3
            low = where(by_1, enter, where(by_2, first, where(by_3, second, third)))
            high = where(by_1, first, where(by_2, second, where(by_3, third, leave)))
            hit = hit & (by_1 | by_2 | by_3 | (side_3 < 0.0))
            t = approach + high
            unclear = hit
            if limit is not None:  # only a crossing between the same two points as the limit has to be found
                unclear = hit & (approach + low < limit) & ~(t < limit)
            if any(unclear):
                t = where(unclear, approach + crossing(torus, p, d, low, high, side_0, unclear), t)
            hit = hit & (t > 0.0)
    return hit, t


def height(torus: PackedTorus, p: Vec) -> Number:
    """Height of a point above the surface; negative in the tube."""
    aside = sqrt(p.x * p.x + p.y * p.y) - torus.ring
    return sqrt(aside * aside + p.z * p.z) - torus.tube


def comes_near(torus: PackedTorus, p: Vec, d: Vec, enter: Number, leave: Number, pad: Number) -> Mask:
    """Whether p + t d may meet the surface: where its middle is no farther from there than from its two ends."""
    middle = p + 0.5 * (enter + leave) * d
    return height(torus, middle) <= 0.5 * (leave - enter) + pad


def side(above: Number) -> Number:
    """Side of the surface on which a point of this height is: 1 outside of the tube, -1 inside."""
    return where(above > 0.0, 1.0, -1.0)


def turning_points(torus: PackedTorus, p: Vec, d: Vec, active: Mask) -> tuple[Number, Number, Number]:
    """The t of the extrema of (|q|^2 + ring^2 - tube^2)^2 - 4 ring^2 (q_x^2 + q_y^2), q = p + t d, in ascending order.

    With p the point of the ray closest to the centre, the derivative is 4 (t^3 + b t + c). Halley's method from beyond
    ends at its root of largest magnitude; a quadratic is left for the other two. Where these are not real two other
    places are returned, which divide an interval without crossings.
    """
    squared = torus.ring * torus.ring
    b = dot(p, p) + squared - torus.tube * torus.tube - 2.0 * squared * (d.x * d.x + d.y * d.y)
    c = -2.0 * squared * (p.x * d.x + p.y * d.y)
    size = fabs(c)
    y = torus.ring * splat(1.415, c)  # no extremum is farther than sqrt(2) ring
    small = 2.0**-22 * torus.ring  # the error after a step is the cube of it
    # A converged lane stays as it is: the rays beside it do not change its answer. Its last bits may differ between
    # kernels, and between the two ways of the BVH, one ray against several tori and several rays against one.
    unconverged = active
    for _ in range(STEPS):
        square = y * y
        value, slope = (square + b) * y - size, 3.0 * square + b
        step = where(unconverged, value * slope / (slope * slope - 3.0 * y * value), 0.0)
        y = y - step
        unconverged = fabs(step) > small
        if not any(unconverged):
            break
    forward = c < 0.0
    far = where(forward, y, -y)
    mean = -0.5 * far
    half = sqrt(maximum(-0.75 * y * y - b, 0.0))
    near, middle = mean - half, mean + half
    return where(forward, near, far), where(forward, middle, near), where(forward, far, middle)


def crossing(torus: PackedTorus, p: Vec, d: Vec, low: Number, high: Number, from_side: Number, active: Mask) -> Number:
    """The t between `low` and `high` at which the ray p + t d, in the frame of the torus, crosses the surface.

    At `low` the ray is on the side `from_side`: 1 outside of the tube, -1 inside. At `high` it is on the other side.
    For rays that are not `active` the result is of no use. Newton's method, with bisection where a step would leave the
    interval (Press et al., Numerical Recipes, 9.4).
    """
    t = 0.5 * (low + high)
    rounding = 4.0 * unit_roundoff(t)
    unconverged = active
    for _ in range(STEPS):
        q = p + t * d
        rho = sqrt(q.x * q.x + q.y * q.y)
        aside = rho - torus.ring
        apart = sqrt(aside * aside + q.z * q.z)
        above = apart - torus.tube
        slope = aside * (q.x * d.x + q.y * d.y) + q.z * d.z * rho  # times rho and the distance to the circle
        before = above * from_side > 0.0
        low = where(before, t, low)
        high = where(before, high, t)
        newton = t - above * (apart * rho) / slope
        nearer = where((newton > low) & (newton < high), newton, 0.5 * (low + high))
        unconverged = unconverged & (fabs(above) > rounding * torus.ring)  # below that it is rounding
        step = where(unconverged, nearer - t, 0.0)
        t = t + step
        unconverged = fabs(step) > rounding * (fabs(t) + torus.tube)
        if not any(unconverged):
            break
    return t


def surface(torus: PackedTorus, point: Vec) -> tuple[Vec, Vec]:
    """The point of the torus nearest to `point`, and the outward normal there."""
    p = own_point(torus, point)
    rho = sqrt(p.x * p.x + p.y * p.y)
    on_axis = rho == 0.0  # on the axis every point of the circle is as near
    per_rho = 1.0 / where(on_axis, 1.0, rho)
    x, y = where(on_axis, 1.0, p.x * per_rho), p.y * per_rho
    aside = rho - torus.ring
    per_apart = 1.0 / sqrt(aside * aside + p.z * p.z)
    across, up = aside * per_apart, p.z * per_apart
    reach = torus.ring + torus.tube * across
    return in_scene(torus, Vec(reach * x, reach * y, torus.tube * up), Vec(across * x, across * y, up))


def mapping(torus: PackedTorus, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """Angle around the axis as u, angle around the tube as v."""
    p, out = own_point(torus, point), own_direction(torus, normal)
    rho = sqrt(p.x * p.x + p.y * p.y)
    per_rho = 1.0 / where(rho == 0.0, 1.0, rho)
    x, y = p.x * per_rho, p.y * per_rho
    across = out.x * x + out.y * y
    u, direction = longitude(p)
    rise = TWO_PI * torus.tube * Vec(-out.z * x, -out.z * y, across)
    v = 0.5 + angle_in_turns(out.z, across)
    return u, v, scene_direction(torus, direction), scene_direction(torus, rise)


def boundary(torus: Any, point: Vec) -> Boundary:
    """Distance from the surface."""
    height, rho = along_and_off_axis(torus.axis, point - torus.centre)
    return Boundary((hypotenuse(rho - torus.diameter / 2, height) - torus.tube / 2,))
