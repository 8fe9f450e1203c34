"""Gate: `ga x,y,z side R,G,B`.

A made-up shape: an upright square around `x,y,z`, seen from both sides. A picture fills it once, seen from +z.

    ga 0,1,20  2  200,200,200    a gate two units wide
"""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.fields import Colour, Length, Point, Triple, declare
from minirt.lanes import Mask, Number, Vec, fabs, unit_roundoff
from minirt.records import record
from minirt.shapes.boundary import Boundary
from minirt.shapes.shape import Ball, Bounds, Position, Shape


@record()
class Gate(Shape):
    """A line `ga` of a scene file."""

    code, title, plural = "ga", "gate", "gates"
    centre: Triple = declare(Point, "centre")
    side: float = declare(Length, "length of a side")
    colour: Triple = declare(Colour, "colour")

    def pack(self) -> PackedGate:
        return PackedGate(Position(Vec(*self.centre)), self.side / 2)

    def bounds(self) -> Bounds:
        (x, y, z), half = self.centre, self.side / 2
        return (x - half, y - half, z), (x + half, y + half, z)

    def balls(self) -> tuple[Ball, ...]:
        (x, y, z), half = self.centre, self.side / 2
        return tuple(((x + i * half, y + j * half, z), 0.0) for i in (-1, 1) for j in (-1, 1))


class PackedGate(NamedTuple):
    """Packed form of a gate."""

    centre: Position
    half: float  # of the side


def intersect(gate: PackedGate, origin: Vec, direction: Vec, limit: Number | None = None) -> tuple[Mask, Number]:
    """Whether and where a ray meets the gate."""
    f = origin - gate.centre
    t = -f.z / direction.z
    p = f + t * direction
    crosses = fabs(direction.z) > 4 * unit_roundoff(t)
    return crosses & (t > 0.0) & (fabs(p.x) <= gate.half) & (fabs(p.y) <= gate.half), t


def surface(gate: PackedGate, point: Vec) -> tuple[Vec, Vec]:
    """The nearest point of the gate's plane, and the normal."""
    flat = 0.0 * point.x
    return Vec(point.x, point.y, gate.centre.z + flat), Vec(flat, flat, 1.0 + flat)


def mapping(gate: PackedGate, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """u and v from 0 to 1 along x and along y."""
    side = 2.0 * gate.half
    p = point - gate.centre
    return 0.5 + p.x / side, 0.5 + p.y / side, Vec(side, 0.0, 0.0), Vec(0.0, side, 0.0)


def boundary(gate: Any, point: Vec) -> Boundary:
    """Height above the gate, and distances beyond its edges."""
    p = point - gate.centre
    return Boundary((p.z,), (abs(p.x) - gate.side / 2, abs(p.y) - gate.side / 2))
