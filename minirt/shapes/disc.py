"""Disc: `di x,y,z nx,ny,nz diameter R,G,B`.

A flat disc, seen from both sides. `x,y,z` is its centre and `nx,ny,nz` its normal. A picture fills the square around
it once, upright for a viewer who faces it; on a floor its upper edge is towards -z, on a ceiling towards z.

    di 0,0,20  0,1,0  6  200,120,120    a table top six units across, seen edge on
"""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.fields import Colour, Direction, Length, Point, Triple, declare
from minirt.lanes import Number, Vec, dot
from minirt.records import record
from minirt.shapes import square
from minirt.shapes.boundary import Boundary, length
from minirt.shapes.plane import meets_plane
from minirt.shapes.shape import Ball, Bounds, Flat, Hit, Position, bounds_of_disc


@record()
class Disc(Flat):
    """A line `di` of a scene file."""

    code, title, plural, revolved, solid = "di", "disc", "discs", True, False
    centre: Triple = declare(Point, "centre")
    normal: Triple = declare(Direction, "normal")
    diameter: float = declare(Length, "diameter")
    colour: Triple = declare(Colour, "colour")

    def pack(self) -> PackedDisc:
        return PackedDisc(Position(Vec(*self.centre)), *self.frame(), self.diameter / 2)

    def balls(self) -> tuple[Ball, ...]:
        return ((self.centre, self.diameter / 2),)

    def bounds(self) -> Bounds:
        return bounds_of_disc(self.centre, self.normal, self.diameter / 2)


class PackedDisc(NamedTuple):
    """Packed form of a disc."""

    centre: Position
    right: Vec  # of pictures on it
    up: Vec
    normal: Vec
    half: float  # of the diameter


surface, mapping = square.surface, square.mapping


def intersect(disc: PackedDisc, origin: Vec, direction: Vec, limit: Number | None = None) -> Hit:
    """Whether and where a ray meets the disc."""
    hit, t, p = meets_plane(disc.centre, disc.normal, origin, direction, limit)
    return hit & (dot(p, p) <= disc.half * disc.half), t


def boundary(disc: Any, point: Vec) -> Boundary:
    """Height above the disc, and distance beyond its rim."""
    p = point - disc.centre
    height = dot(disc.normal, p)
    return Boundary((height,), (length(p - height * disc.normal) - disc.diameter / 2,))
