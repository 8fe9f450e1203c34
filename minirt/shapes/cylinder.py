"""Cylinder: `cy x,y,z ax,ay,az diameter height R,G,B`.

A solid cylinder with both caps about the axis `ax,ay,az`; `x,y,z` is its centre, half-way up. A picture lies once
around the side, with its middle towards -z on an upright cylinder, and once on the square around each cap.

    cy 0,0,20  0,1,0  2  5  255,200,0    an upright column, from y = -2.5 to y = 2.5
"""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.fields import Colour, Direction, Length, Point, Triple, declare
from minirt.lanes import Mask, Number, Vec, any, copysign, fabs, maximum, minimum, rarely, splat, sqrt, where
from minirt.records import record
from minirt.shapes.boundary import Boundary, along_and_off_axis
from minirt.shapes.compensated import axis_low, minus, two_product, value
from minirt.shapes.frames import from_basis, is_side, revolved_mapping, to_basis
from minirt.shapes.shape import Axial, Ball, Bounds, Position, bounds_of_disc, point_along, union_of_bounds
from minirt.shapes.start import (
    CLOSE,
    axial,
    beside_side,
    between_caps,
    clamped_minimum,
    error_of_start,
    negative_interval,
    product_of_roots,
    starts_close,
    within_shell,
)


@record()
class Cylinder(Axial):
    """A line `cy` of a scene file."""

    code, title, plural, revolved = "cy", "cylinder", "cylinders", True
    centre: Triple = declare(Point, "centre, half-way up")
    axis: Triple = declare(Direction, "axis")
    diameter: float = declare(Length, "diameter")
    height: float = declare(Length, "height")
    colour: Triple = declare(Colour, "colour")

    def pack(self) -> PackedCylinder:
        u, v, w = self.frame()
        return PackedCylinder(
            Position(Vec(*self.centre)), u, v, w, axis_low(self.axis), self.diameter / 2, self.height / 2
        )

    def ends(self) -> tuple[Triple, Triple]:
        return point_along(self.centre, self.axis, self.height / 2), point_along(
            self.centre, self.axis, -self.height / 2
        )

    def balls(self) -> tuple[Ball, ...]:
        return tuple((end, self.diameter / 2) for end in self.ends())

    def bounds(self) -> Bounds:
        return union_of_bounds(*(bounds_of_disc(end, self.axis, self.diameter / 2) for end in self.ends()))


class PackedCylinder(NamedTuple):
    """Packed form of a cylinder: its own frame, in which it stands upright at the origin."""

    centre: Position
    u: Vec
    v: Vec
    w: Vec  # the axis
    w_low: Vec  # what the rounded axis lacks
    radius: float
    half: float  # of the height


def intersect(cylinder: PackedCylinder, origin: Vec, direction: Vec) -> tuple[Mask, Number]:
    """Whether and where a ray meets the cylinder, wherever it starts."""
    return solve(cylinder, origin, direction, True)


def occludes(cylinder: PackedCylinder, origin: Vec, direction: Vec) -> tuple[Mask, Number]:
    """Whether and where a shadow ray, which starts clear of all surfaces, meets the cylinder."""
    return solve(cylinder, origin, direction, None)


def solve(cylinder: PackedCylinder, origin: Vec, direction: Vec, anywhere: bool | None) -> tuple[Mask, Number]:
    """Whether and where a ray meets the cylinder.

    The ray is inside the infinite tube for one interval of t and between the planes of the caps for another; it is
    inside the cylinder where these overlap. There is no crack between cap and side, whatever the rounding.

    Shadow rays pass None for `anywhere`: see `minirt.shapes.start`.
    """
    p = to_basis(cylinder.u, cylinder.v, cylinder.w, origin - cylinder.centre)
    d = to_basis(cylinder.u, cylinder.v, cylinder.w, direction)
    a = d.x * d.x + d.y * d.y
    b = p.x * d.x + p.y * d.y
    squared = cylinder.radius * cylinder.radius
    per_a, per_height = 1.0 / a, 1.0 / d.z
    bottom = (-cylinder.half - p.z) * per_height
    top = (cylinder.half - p.z) * per_height
    first, last = minimum(bottom, top), maximum(bottom, top)
    start = clamped_minimum(per_a, b, first, last)
    q = p + start * d
    half_b = q.x * d.x + q.y * d.y
    product = c = q.x * q.x + q.y * q.y - squared
    if anywhere is not None:
        level = p.x * p.x + p.y * p.y - squared
        if rarely(level <= CLOSE * squared):  # few rays start within the endless tube
            over, size = fabs(p.z) - cylinder.half, cylinder.radius + cylinder.half
            close = within_shell(level, squared, over, size) & starts_close(a, b, level, squared, over, size, p.z * d.z)
            if any(close):
                height, power = axial(origin, cylinder.centre, cylinder.w, cylinder.w_low, a)
                radius = splat(cylinder.radius, a)
                exact_level = value(minus(power, two_product(radius, radius)))
                error = error_of_start(origin, p, level, cylinder.radius, over)
                low, high = between_caps(height, -cylinder.half, cylinder.half, per_height, error)
                first, last = where(close, low, first), where(close, high, last)
                beside = close & beside_side(level, squared, over, cylinder.half)
                start = where(beside, 0.0, where(close, clamped_minimum(per_a, b, low, high), start))
                q = p + start * d
                half_b = q.x * d.x + q.y * d.y
                c = where(beside, exact_level, q.x * q.x + q.y * q.y - squared)
                product = product_of_roots(beside, c, cylinder.radius, error)
    hit, below, above = negative_interval(a, per_a, half_b, c, product)
    t = start
    if any(hit):
        near = maximum(start + below, first)
        far = minimum(start + above, last)
        t = where(near > 0.0, near, far)
        hit = hit & (near <= far) & (t > 0.0)
    return hit, t


def surface(cylinder: PackedCylinder, point: Vec) -> tuple[Vec, Vec]:
    """`point` moved onto the side or the cap, whichever is nearer, and the outward normal there."""
    p = to_basis(cylinder.u, cylinder.v, cylinder.w, point - cylinder.centre)
    rho = sqrt(p.x * p.x + p.y * p.y)
    up = copysign(1.0, p.z)
    side = rho - cylinder.radius >= fabs(p.z) - cylinder.half
    flat = splat(0.0, p.z)
    out = where(side, Vec(p.x, p.y, flat) / rho, Vec(flat, flat, up))
    on = where(side, Vec(out.x * cylinder.radius, out.y * cylinder.radius, p.z), Vec(p.x, p.y, up * cylinder.half))
    return (
        cylinder.centre + from_basis(cylinder.u, cylinder.v, cylinder.w, on),
        from_basis(cylinder.u, cylinder.v, cylinder.w, out),
    )


def mapping(cylinder: PackedCylinder, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """Angle around the side as u, height as v; on the caps the square around them."""
    u, v, w = cylinder.u, cylinder.v, cylinder.w
    p = to_basis(u, v, w, point - cylinder.centre)
    side = is_side(p, to_basis(u, v, w, normal))
    tall = 2.0 * cylinder.half
    return revolved_mapping(u, v, w, p, side, 0.5 + p.z / tall, Vec(0.0, 0.0, tall), cylinder.radius)


def boundary(cylinder: Any, point: Vec) -> Boundary:
    """Distances from the side and from the caps."""
    height, rho = along_and_off_axis(cylinder.axis, point - cylinder.centre)
    return Boundary((rho - cylinder.diameter / 2, abs(height) - cylinder.height / 2))
