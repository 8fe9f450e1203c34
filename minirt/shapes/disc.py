"""Disc: `di x,y,z nx,ny,nz diameter R,G,B`.

A flat disc, seen from both sides. `x,y,z` is its centre and `nx,ny,nz` its normal. A picture fills the square around
it once, upright for a viewer who faces it; on a floor its upper edge is towards -z, on a ceiling towards z.

    di 0,0,20  0,1,0  6  200,120,120    a table top six units across, seen edge on
"""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.fields import Colour, Direction, Length, Point, Triple, declare
from minirt.lanes import Mask, Number, Vec, dot
from minirt.records import record
from minirt.shapes.boundary import Boundary, length
from minirt.shapes.plane import crossing, least_t
from minirt.shapes.shape import Ball, Bounds, Flat, Position, bounds_of_disc


@record()
class Disc(Flat):
    """A line `di` of a scene file."""

    code, title, plural, revolved, solid = "di", "disc", "discs", True, False
    centre: Triple = declare(Point, "centre")
    normal: Triple = declare(Direction, "normal")
    diameter: float = declare(Length, "diameter")
    colour: Triple = declare(Colour, "colour")

    def pack(self) -> PackedDisc:
        right, up, _ = self.frame()
        return PackedDisc(Position(Vec(*self.centre)), right, up, Vec(*self.normal), self.diameter / 2)

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
    radius: float


def intersect(disc: PackedDisc, origin: Vec, direction: Vec) -> tuple[Mask, Number]:
    """Whether and where a ray meets the disc; one that is parallel to it, or starts on it, within rounding, does
    not."""
    f = origin - disc.centre
    height = dot(disc.normal, f)
    return within(disc, f, height, direction, least_t(origin, f, height, disc.radius))


def occludes(disc: PackedDisc, origin: Vec, direction: Vec) -> tuple[Mask, Number]:
    """Whether and where a shadow ray, which starts clear of all surfaces, meets the disc."""
    f = origin - disc.centre
    return within(disc, f, dot(disc.normal, f), direction, 0.0)


def within(disc: PackedDisc, f: Vec, height: Number, direction: Vec, least: Number) -> tuple[Mask, Number]:
    """Whether and where a ray from f, relative to the centre, meets the disc, at a t of more than the `least`."""
    hit, t, p = crossing(disc.normal, f, height, direction, least)
    return hit & (dot(p, p) <= disc.radius * disc.radius), t


def surface(disc: PackedDisc, point: Vec) -> tuple[Vec, Vec]:
    """`point` projected onto the disc's plane, and the normal."""
    height = dot(disc.normal, point - disc.centre)
    return point - height * disc.normal, disc.normal


def mapping(disc: PackedDisc, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """u and v from 0 to 1 across the square around the disc."""
    p = point - disc.centre
    across = 2.0 * disc.radius
    per_diameter = 1.0 / across
    u, v = 0.5 + dot(p, disc.right) * per_diameter, 0.5 + dot(p, disc.up) * per_diameter
    return u, v, across * disc.right, across * disc.up


def boundary(disc: Any, point: Vec) -> Boundary:
    """Height above the disc, and distance beyond its rim."""
    p = point - disc.centre
    height = dot(disc.normal, p)
    return Boundary((height,), (length(p - height * disc.normal) - disc.diameter / 2,))
