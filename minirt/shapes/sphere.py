"""Sphere: `sp x,y,z diameter R,G,B`.

All points at the distance of half the `diameter` from the centre `x,y,z`. A picture lies around it once like a map of
the earth, in equal steps of longitude and latitude: its upper edge at the pole +y, its middle towards -z.

    sp 0,0,20  12.6  10,0,255       a blue ball 20 units along z from the origin
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from minirt.fields import Colour, Length, Point, Triple, declare
from minirt.lanes import Vec, any, dot, fabs, rarely, splat, sqrt, unit, unit_roundoff, where
from minirt.lanes.operations import Mask
from minirt.lanes.vec import Number
from minirt.shapes.compensated import power
from minirt.shapes.shape import Ball, Box, Place, Shape
from minirt.shapes.uv_mapping import TURN, turns

CLOSE = 2.0**-6  # to the surface: |f|^2 / radius^2 - 1
ROUNDING = 16  # of the same, in unit roundoffs, and more


@dataclass(frozen=True)
class Sphere(Shape):
    """A line `sp` of a scene file."""

    code, title, plural = "sp", "sphere", "spheres"
    centre: Triple = declare(Point, "centre")
    diameter: float = declare(Length, "diameter")
    colour: Triple = declare(Colour, "colour")

    def pack(self) -> PackedSphere:
        return PackedSphere(Place(Vec(*self.centre)), self.diameter / 2)

    def balls(self) -> tuple[Ball, ...]:
        return ((self.centre, self.diameter / 2),)

    def bounds(self) -> Box:
        x, y, z = self.centre
        r = self.diameter / 2
        return (x - r, y - r, z - r), (x + r, y + r, z + r)


class PackedSphere(NamedTuple):
    """What the kernel keeps of a sphere."""

    centre: Place
    radius: float


def intersect(sphere: PackedSphere, origin: Vec, direction: Vec) -> tuple[Mask, Number]:
    """Whether and where a ray meets the sphere.

    From the ray's closest approach to the centre both hits are equally far: half a chord, by Pythagoras. Starting
    there instead of at the origin keeps full precision for small spheres that are far away. Close above or below the
    surface, seen on the scale of the sphere, one of the hits is the little that is left of the approach and half the
    chord: there it follows from the other one, because the product of both is the power of the origin. A ray that
    leaves the sphere, as those from its surface to a lamp do, never meets it again.
    """
    f = origin - sphere.centre
    squared = sphere.radius * sphere.radius
    height = dot(f, f) - squared  # of the origin above the surface, times a length
    approach = -dot(f, direction)
    g = f + approach * direction  # from the centre to the closest approach
    chord = squared - dot(g, g)  # the square of half of it
    leaving = (approach <= 0.0) & (height > ROUNDING * unit_roundoff(height) * squared)
    close = fabs(height) <= CLOSE * squared
    hit = ((chord >= 0.0) | close) & ~leaving
    t = approach
    if any(hit):
        close = hit & close
        product = chord
        if rarely(close):
            product = splat(power(origin, sphere.centre, sphere.radius), chord)
            chord = where(close, approach * approach - product, chord)
        half = sqrt(chord)
        near = approach - half
        far = approach + half
        if rarely(close):
            near = where(close & (approach > 0.0), product / far, near)
            far = where(close & (approach <= 0.0), product / near, far)
        t = where(near > 0.0, near, far)
        hit = hit & (t > 0.0)  # NaN where there is no chord
    return hit, t


def surface(sphere: PackedSphere, point: Vec) -> tuple[Vec, Vec]:
    """The point of the sphere nearest to `point`, and the outward normal."""
    normal = unit(point - sphere.centre)
    return sphere.centre + sphere.radius * normal, normal


def mapping(sphere: PackedSphere, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """Longitude and latitude, each from 0 to 1. At the poles the tangents are zero."""
    rho = sqrt(normal.x * normal.x + normal.z * normal.z)
    per_rho = 1.0 / where(rho == 0.0, 1.0, rho)
    half = 0.5 * TURN * sphere.radius
    fall = -normal.y * per_rho
    u, v = 0.5 + turns(-normal.x, -normal.z), 0.5 + 2.0 * turns(normal.y, rho)
    along_u = 2.0 * half * Vec(normal.z, 0.0, -normal.x)
    along_v = half * Vec(fall * normal.x, rho, fall * normal.z)
    return u, v, along_u, along_v
