"""Plane: `pl x,y,z nx,ny,nz R,G,B`.

An infinite plane, seen from both sides: all points p for which `p - (x,y,z)` is perpendicular to the normal `nx,ny,nz`.
Pictures are one unit wide and high and repeated without end, the lower left corner of one at `x,y,z`. They stand
upright; on a floor u, to the right, runs along x and v, upwards, along -z, on a ceiling along x and z. `uv:0.25,0.25`
makes them four units wide and high, `roll:degrees` turns them about the normal.

    pl 0,-1,0  0,1,0  200,200,200    a floor one unit below the origin
"""

from __future__ import annotations

from dataclasses import KW_ONLY
from typing import Any, NamedTuple

from minirt.fields import Colour, Direction, Point, Triple, declare
from minirt.lanes import Mask, Number, Vec, dot, fabs, unit_roundoff
from minirt.materials import BOARD, Checker, Compound
from minirt.records import record
from minirt.shapes.boundary import Boundary
from minirt.shapes.compensated import position_error
from minirt.shapes.shape import Ball, Flat, Hit, Position

PARALLEL = 4  # error of the scalar product of two unit vectors, in unit roundoffs


@record()
class Plane(Flat):
    """A line `pl` of a scene file."""

    code, title, plural, infinite, revolved = "pl", "plane", "planes", True, True
    point: Triple = declare(Point, "a point of the plane")
    normal: Triple = declare(Direction, "normal")
    colour: Triple = declare(Colour, "colour")
    _: KW_ONLY
    checker: Checker | None = declare(Compound, "checkerboard", bare="1", default=None, shared=BOARD)

    def pack(self) -> PackedPlane:
        return PackedPlane(Position(Vec(*self.point)), *self.frame())

    def balls(self) -> tuple[Ball, ...]:
        return ()

    def infinite_plane(self) -> tuple[Triple, Triple]:
        return self.point, self.normal

    def bounds(self) -> None:
        return None


class PackedPlane(NamedTuple):
    """Packed form of a plane."""

    point: Position
    right: Vec  # of pictures
    up: Vec
    normal: Vec


def intersect(plane: PackedPlane, origin: Vec, direction: Vec, limit: Number | None = None) -> Hit:
    """Whether and where a ray meets the plane."""
    hit, t, _ = meets_plane(plane.point, plane.normal, origin, direction, limit)
    return hit, t


def meets_plane(point: Vec, normal: Vec, origin: Vec, direction: Vec, limit: Number | None) -> tuple[Mask, Number, Vec]:
    """Whether and where a ray meets the plane through a point: t, and the place that is met, relative to the point.

    A ray that is parallel to the plane, or starts on it, to rounding, does not meet it.
    """
    f = origin - point
    height, slope = dot(normal, f), dot(normal, direction)
    t = -height / slope
    hit = (fabs(slope) > PARALLEL * unit_roundoff(slope)) & (t > 0.0)
    if limit is None:
        hit = hit & (fabs(height) > position_error(origin, f))
    return hit, t, f + t * direction


def surface(plane: PackedPlane, point: Vec) -> tuple[Vec, Vec]:
    """The point of the plane nearest to `point`, and the normal."""
    height = dot(plane.normal, point - plane.point)
    return point - height * plane.normal, plane.normal


def mapping(plane: PackedPlane, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """u and v in scene units, and the unit vectors along them."""
    p = point - plane.point
    return dot(p, plane.right), dot(p, plane.up), plane.right, plane.up


def boundary(plane: Any, point: Vec) -> Boundary:
    """Height above the plane."""
    return Boundary((dot(plane.normal, point - plane.point),))
