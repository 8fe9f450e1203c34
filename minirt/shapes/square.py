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
from minirt.lanes import Mask, Number, Vec, dot, fabs
from minirt.records import record
from minirt.shapes.boundary import Boundary, upright_frame
from minirt.shapes.plane import crossing, least_t
from minirt.shapes.shape import Ball, Bounds, Flat, Position, bounds_of_points, point_along


@record()
class Square(Flat):
    """A line `sq` of a scene file."""

    code, title, plural, solid = "sq", "square", "squares", False
    centre: Triple = declare(Point, "centre")
    normal: Triple = declare(Direction, "normal")
    side: float = declare(Length, "side")
    colour: Triple = declare(Colour, "colour")

    def pack(self) -> PackedSquare:
        right, up, _ = self.frame()
        return PackedSquare(Position(Vec(*self.centre)), right, up, Vec(*self.normal), self.side / 2)

    def corners(self) -> tuple[Triple, ...]:
        half = self.side / 2
        right, up, _ = ((axis.x, axis.y, axis.z) for axis in self.frame())
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
    height = dot(square.normal, f)
    return within(square, f, height, direction, least_t(origin, f, height, square.half))


def occludes(square: PackedSquare, origin: Vec, direction: Vec) -> tuple[Mask, Number]:
    """Whether and where a shadow ray, which starts clear of all surfaces, meets the square."""
    f = origin - square.centre
    return within(square, f, dot(square.normal, f), direction, 0.0)


def within(square: PackedSquare, f: Vec, height: Number, direction: Vec, least: Number) -> tuple[Mask, Number]:
    """Whether and where a ray from f, relative to the centre, meets the square, at a t of more than the `least`."""
    hit, t, p = crossing(square.normal, f, height, direction, least)
    return hit & (fabs(dot(p, square.right)) <= square.half) & (fabs(dot(p, square.up)) <= square.half), t


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
    right, up = upright_frame(square.normal, square.roll)
    half = square.side / 2
    return Boundary((dot(square.normal, p),), (abs(dot(right, p)) - half, abs(dot(up, p)) - half))
