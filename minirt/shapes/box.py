"""Box: `bo x,y,z ax,ay,az w,h,d R,G,B`.

A solid block. `x,y,z` is its centre, `ax,ay,az` its own y axis, and `w,h,d` are its sizes along its own x, y and z
axes. Its axes are those of the scene, turned no further than it takes to bring y to `ax,ay,az`, or to its opposite;
`roll:degrees` then turns the box about its own y axis. Each face has a picture of its own: upright on the four standing
faces, with its upper edge towards -z above and z below.

    bo 0,1,20  0,1,0  4,2,6  160,160,170    an upright block four wide, two high and six deep
"""

from __future__ import annotations

from itertools import product
from math import inf
from typing import Any, NamedTuple

from minirt.fields import Colour, Direction, Lengths, Point, Triple, declare
from minirt.lanes import Number, Vec, copysign, fabs, maximum, minimum, rarely, splat, where
from minirt.records import record
from minirt.shapes.boundary import Boundary, own_coordinates
from minirt.shapes.compensated import position_error
from minirt.shapes.frames import in_scene, own_direction, own_point
from minirt.shapes.shape import Axial, Ball, Hit, Position, point_along


@record()
class Box(Axial):
    """A line `bo` of a scene file."""

    code, title, plural = "bo", "box", "boxes"
    centre: Triple = declare(Point, "centre")
    axis: Triple = declare(Direction, "its own y axis")
    sizes: Triple = declare(Lengths, "sizes along its own x, y and z axes", names="w,h,d")
    colour: Triple = declare(Colour, "colour")

    def axes(self) -> tuple[Vec, Vec, Vec]:
        """The own x, y and z axes of the box."""
        z, x, y = self.frame()
        return x, y, z

    def pack(self) -> PackedBox:
        half = Vec(*(size / 2 for size in self.sizes))
        return PackedBox(Position(Vec(*self.centre)), *self.axes(), half)

    def corners(self) -> list[Triple]:
        found = [self.centre]
        for axis, size in zip(self.axes(), self.sizes, strict=True):
            way = axis.x, axis.y, axis.z
            found = [point_along(corner, way, sign * size / 2) for corner, sign in product(found, (-1, 1))]
        return found

    def balls(self) -> tuple[Ball, ...]:
        return tuple((corner, 0.0) for corner in self.corners())


class PackedBox(NamedTuple):
    """Packed form of a box: its own frame, in which it stands upright at the origin."""

    centre: Position
    u: Vec
    v: Vec
    w: Vec
    half: Vec  # of the sizes


def intersect(box: PackedBox, origin: Vec, direction: Vec, limit: Number | None = None) -> Hit:
    """Whether a ray meets the box, and the least t > 0 at which it does; `limit` as in `minirt.shapes.shape`.

    A face on which the ray starts, within rounding, is not met there again.

    Slab test: the ray is between each pair of faces for an interval of t, and in the box where all three overlap (Kay
    and Kajiya, Ray Tracing Complex Scenes, 1986). For a ray exactly in the plane of a face 0 times infinity is NaN: in
    that of x = half, y = half or z = half the ray passes between this pair of faces, in that of -half it passes beside
    them. So one of two boxes that share a face is hit by the rays in it. `maximum` and `minimum` ignore NaN in their
    first argument alone.
    """
    p, d = own_point(box, origin), own_direction(box, direction)
    enter_x, leave_x = slab_interval(p.x, d.x, box.half.x)
    enter_y, leave_y = slab_interval(p.y, d.y, box.half.y)
    enter_z, leave_z = slab_interval(p.z, d.z, box.half.z)
    hit, t = first_in_all(enter_x, enter_y, enter_z, leave_x, leave_y, leave_z)
    if limit is None:
        error = position_error(origin, origin - box.centre)
        over = maximum(maximum(fabs(p.x) - box.half.x, fabs(p.y) - box.half.y), fabs(p.z) - box.half.z)
        close = fabs(over) <= error
        if rarely(close):
            error = where(close, error, -1.0)  # -1: such a ray starts on no face
            enter_x, leave_x = beyond_start(p.x, d.x, box.half.x, error, enter_x, leave_x)
            enter_y, leave_y = beyond_start(p.y, d.y, box.half.y, error, enter_y, leave_y)
            enter_z, leave_z = beyond_start(p.z, d.z, box.half.z, error, enter_z, leave_z)
            onward, t = first_in_all(enter_x, enter_y, enter_z, leave_x, leave_y, leave_z)
            hit = hit & onward
    return hit, t


def first_in_all(
    enter_x: Number, enter_y: Number, enter_z: Number, leave_x: Number, leave_y: Number, leave_z: Number
) -> Hit:
    """Whether three intervals overlap at t > 0, and the first end of the overlap with t > 0."""
    enter = maximum(enter_z, maximum(enter_y, maximum(enter_x, -inf)))
    leave = minimum(leave_z, minimum(leave_y, minimum(leave_x, inf)))
    t = where(enter > 0.0, enter, leave)
    return (enter <= leave) & (t > 0.0), t


def beyond_start(
    p: Number, d: Number, half: Number, error: Number, enter: Number, leave: Number
) -> tuple[Number, Number]:
    """The interval of `slab_interval` for rays that may start on a face, within `error`: there they are inside
    already, or no more."""
    starts = fabs(fabs(p) - half) <= error
    way = p * d
    return where(starts & (way < 0.0), -inf, enter), where(starts & (way > 0.0), 0.0, leave)


def slab_interval(p: Number, d: Number, half: Number) -> tuple[Number, Number]:
    """The interval of t in which the coordinate p + t d lies between -half and half.

    For d = 0 and p = half both ends are NaN; for d = 0 and p = -half both are the same infinity.
    """
    per_step = 1.0 / d
    one = (-half - p) * per_step
    other = (half - p) * per_step
    return minimum(one, other), maximum(one, other)


def surface(box: PackedBox, point: Vec) -> tuple[Vec, Vec]:
    """`point` moved onto the nearest face, and the outward normal there."""
    p = own_point(box, point)
    x, y, z = fabs(p.x) - box.half.x, fabs(p.y) - box.half.y, fabs(p.z) - box.half.z
    by_x, by_y = (x >= y) & (x >= z), y >= z  # by y only where not by x
    flat = splat(0.0, p.x)
    out = where(
        by_x,
        Vec(copysign(1.0, p.x), flat, flat),
        where(by_y, Vec(flat, copysign(1.0, p.y), flat), Vec(flat, flat, copysign(1.0, p.z))),
    )
    on = p - where(by_x, x, where(by_y, y, z)) * out
    return in_scene(box, on, out)


def mapping(box: PackedBox, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """u and v from 0 to 1 across each face; v runs along the box's y axis on the four standing faces."""
    p, out = own_point(box, point), own_direction(box, normal)
    by_x, by_y = fabs(out.x) > 0.5, fabs(out.y) > 0.5
    sign = copysign(1.0, where(by_x, -out.x, where(by_y, -out.y, out.z)))
    wide, tall, deep = 2.0 * box.half.x, 2.0 * box.half.y, 2.0 * box.half.z
    by_z = sign * p.z / deep
    return (
        0.5 + where(by_x, by_z, where(by_y, p.x, sign * p.x) / wide),
        0.5 + where(by_y, by_z, p.y / tall),
        where(by_x, sign * deep, 0.0) * box.w + where(by_x, 0.0, where(by_y, wide, sign * wide)) * box.u,
        where(by_y, sign * deep, 0.0) * box.w + where(by_y, 0.0, tall) * box.v,
    )


def boundary(box: Any, point: Vec) -> Boundary:
    """Distances from the three pairs of faces."""
    x, y, z = own_coordinates(box.axis, box.roll, point - box.centre)
    return Boundary((abs(x) - box.sizes.x / 2, abs(y) - box.sizes.y / 2, abs(z) - box.sizes.z / 2))
