"""Square: `sq x,y,z nx,ny,nz side R,G,B`.

A flat square, seen from both sides. `x,y,z` is its centre and `nx,ny,nz` its normal. It stands upright: one pair of
edges is horizontal; on a floor and a ceiling the edges are along x and z. `roll:degrees` turns it about its normal. A
picture fills it once, upright for a viewer who faces it; on a floor its upper edge is towards -z, on a ceiling towards
z.

    sq 0,2,20  0,0,-1  4  200,200,120    a board four units wide and high that faces the origin
"""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.fields import Colour, Direction, Length, Point, Triple, declare
from minirt.lanes import Number, Vec, dot, fabs
from minirt.records import record
from minirt.shapes.boundary import Boundary, upright_frame
from minirt.shapes.plane import meets_plane
from minirt.shapes.shape import Ball, Flat, Hit, Position, point_along


@record()
class Square(Flat):
    """A line `sq` of a scene file."""

    code, title, plural, solid = "sq", "square", "squares", False
    centre: Triple = declare(Point, "centre")
    normal: Triple = declare(Direction, "normal")
    side: float = declare(Length, "side")
    colour: Triple = declare(Colour, "colour")

    def pack(self) -> PackedSquare:
        return PackedSquare(Position(Vec(*self.centre)), *self.frame(), self.side / 2)

    def corners(self) -> tuple[Triple, ...]:
        half = self.side / 2
        right, up, _ = ((axis.x, axis.y, axis.z) for axis in self.frame())
        ends = [point_along(self.centre, right, x) for x in (-half, half)]
        return tuple(point_along(end, up, y) for end in ends for y in (-half, half))

    def balls(self) -> tuple[Ball, ...]:
        return tuple((corner, 0.0) for corner in self.corners())


class PackedSquare(NamedTuple):
    """Packed form of a square."""

    centre: Position
    right: Vec
    up: Vec
    normal: Vec
    half: float  # of a side


def intersect(square: PackedSquare, origin: Vec, direction: Vec, limit: Number | None = None) -> Hit:
    """Whether and where a ray meets the square."""
    hit, t, p = meets_plane(square.centre, square.normal, origin, direction, limit)
    return hit & (fabs(dot(p, square.right)) <= square.half) & (fabs(dot(p, square.up)) <= square.half), t


def surface(flat: Any, point: Vec) -> tuple[Vec, Vec]:
    """`point` projected onto the plane of a square or disc, and the normal."""
    height = dot(flat.normal, point - flat.centre)
    return point - height * flat.normal, flat.normal


def mapping(flat: Any, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """u and v from 0 to 1 across the square, or the one around the disc."""
    p = point - flat.centre
    side = 2.0 * flat.half
    per_side = 1.0 / side
    u, v = 0.5 + dot(p, flat.right) * per_side, 0.5 + dot(p, flat.up) * per_side
    return u, v, side * flat.right, side * flat.up


def boundary(square: Any, point: Vec) -> Boundary:
    """Height above the square, and distances beyond its two pairs of edges."""
    p = point - square.centre
    right, up = upright_frame(square.normal, square.roll)
    half = square.side / 2
    return Boundary((dot(square.normal, p),), (abs(dot(right, p)) - half, abs(dot(up, p)) - half))
