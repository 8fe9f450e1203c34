"""Square: `sq x,y,z nx,ny,nz side R,G,B`.

A flat square, seen from both sides. `x,y,z` is its centre and `nx,ny,nz` its normal. It stands upright: one pair of
edges is horizontal; on a floor and a ceiling the edges are along x and z. A picture fills it once, upright for
a viewer who faces it; on a floor its upper edge is towards -z, on a ceiling towards z.

    sq 0,2,20  0,0,-1  4  200,200,120    a board four units wide and high that faces the origin
"""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.fields import Colour, Direction, Length, Point, Triple, declare
from minirt.lanes import Vec, dot, fabs, rarely, unit_roundoff
from minirt.lanes.operations import Mask
from minirt.lanes.vec import Number
from minirt.records import record
from minirt.shapes.basis import facing_frame
from minirt.shapes.boundary import Boundary, upright_frame
from minirt.shapes.bounds import bounds_of_points, point_along
from minirt.shapes.flat_start import CLOSE, start_error
from minirt.shapes.plane import PARALLEL
from minirt.shapes.shape import Ball, Bounds, Position, Shape


@record()
class Square(Shape):
    """A line `sq` of a scene file."""

    code, title, plural, solid = "sq", "square", "squares", False
    centre: Triple = declare(Point, "centre")
    normal: Triple = declare(Direction, "normal")
    side: float = declare(Length, "side")
    colour: Triple = declare(Colour, "colour")

    def pack(self) -> PackedSquare:
        right, up = facing_frame(self.normal)
        return PackedSquare(Position(Vec(*self.centre)), right, up, Vec(*self.normal), self.side / 2)

    def corners(self) -> tuple[Triple, ...]:
        half = self.side / 2
        right, up = ((axis.x, axis.y, axis.z) for axis in facing_frame(self.normal))
        return tuple(
            point_along(point_along(self.centre, right, x), up, y) for x in (-half, half) for y in (-half, half)
        )

    def balls(self) -> tuple[Ball, ...]:
        return tuple((corner, 0.0) for corner in self.corners())

    def bounds(self) -> Bounds:
        return bounds_of_points(*self.corners())


class PackedSquare(NamedTuple):
    """Packed form of a square."""

    centre: Position
    right: Vec
    up: Vec
    normal: Vec
    half: float  # of a side


def intersect(square: PackedSquare, origin: Vec, direction: Vec) -> tuple[Mask, Number]:
    """Whether and where a ray meets the square; one that is parallel to it, or starts on it, within rounding, does
    not."""
    f = origin - square.centre
    slope = dot(square.normal, direction)
    height = dot(square.normal, f)
    t = -height / slope
    p = f + t * direction
    hit = (fabs(slope) > PARALLEL * unit_roundoff(slope)) & (t > 0.0)
    hit = hit & (fabs(dot(p, square.right)) <= square.half) & (fabs(dot(p, square.up)) <= square.half)
    close = hit & (t < CLOSE * square.half)
    if rarely(close):
        hit = hit & ~(close & (fabs(height) <= start_error(origin, f)))
    return hit, t


def surface(square: PackedSquare, point: Vec) -> tuple[Vec, Vec]:
    """`point` projected onto the square's plane, and the normal."""
    height = dot(square.normal, point - square.centre)
    return point - height * square.normal, square.normal


def mapping(square: PackedSquare, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """u and v from 0 to 1 from edge to edge."""
    p = point - square.centre
    side = 2.0 * square.half
    per_side = 1.0 / side
    u, v = 0.5 + dot(p, square.right) * per_side, 0.5 + dot(p, square.up) * per_side
    return u, v, side * square.right, side * square.up


def boundary(square: Any, point: Vec) -> Boundary:
    """Height above the square, and distances beyond its two pairs of edges."""
    p = point - square.centre
    right, up = upright_frame(square.normal)
    half = square.side / 2
    return Boundary((dot(square.normal, p),), (abs(dot(right, p)) - half, abs(dot(up, p)) - half))
