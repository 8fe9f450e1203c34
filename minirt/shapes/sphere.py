"""Sphere: `sp x,y,z diameter R,G,B`.

A solid ball: `x,y,z` is its centre. A picture lies around it once like a map of the earth, in equal steps of longitude
and latitude (equirectangular projection): its upper edge at the pole +y, its middle towards -z. `axis:ax,ay,az` puts
the upper edge elsewhere, and `roll:degrees` turns the picture about that axis.

    sp 0,0,20  12.6  10,0,255       a blue ball 20 units along z from the origin
"""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.fields import Colour, Length, Point, Triple, declare
from minirt.lanes import Number, Vec, any, dot, fabs, outlined, rarely, splat, sqrt, unit, unit_roundoff, where
from minirt.records import record
from minirt.shapes.boundary import Boundary, length
from minirt.shapes.compensated import minus, offset, position_error, scalar_product, square_of, value, zero_within
from minirt.shapes.frames import TWO_PI, angle_in_turns
from minirt.shapes.shape import Ball, Bounds, Frame, Hit, Position, Turnable

CLOSE = 2.0**-6  # to the surface: |f|^2 / radius^2 - 1
ROUNDING = 16  # unit roundoffs by which |f|^2 / radius^2 - 1 may be off, and more


@record()
class Sphere(Turnable):
    """A line `sp` of a scene file."""

    code, title, plural, revolved, columnar, convex = "sp", "sphere", "spheres", True, True, True
    centre: Triple = declare(Point, "centre")
    diameter: float = declare(Length, "diameter")
    colour: Triple = declare(Colour, "colour")

    def pack(self) -> PackedSphere:
        return PackedSphere(Position(Vec(*self.centre)), self.diameter / 2)

    @property
    def shows_axis(self) -> bool:
        return self.is_mapped

    def map_frame(self) -> Frame | None:
        return self.frame() if self.is_turned else None

    def balls(self) -> tuple[Ball, ...]:
        return ((self.centre, self.diameter / 2),)

    def bounds(self) -> Bounds:
        x, y, z = self.centre
        r = self.diameter / 2
        return (x - r, y - r, z - r), (x + r, y + r, z + r)


class PackedSphere(NamedTuple):
    """Packed form of a sphere."""

    centre: Position
    radius: float


def intersect(sphere: PackedSphere, origin: Vec, direction: Vec, limit: Number | None = None) -> Hit:
    """Whether a ray meets the sphere, and the least t > 0 at which it does; `limit` as in `minirt.shapes.shape`.

    Both hits lie half a chord from the ray's closest approach to the centre, by Pythagoras. Counting t from there
    instead of the origin keeps full precision for small spheres that are far away. For an origin close to the surface,
    on the scale of the sphere, the nearer hit would be the small difference of approach and half chord: it is computed
    from the farther one instead, because the product of both is the power of the origin. A ray that leaves the sphere,
    such as a shadow ray from its surface, never meets it again.
    """
    f = origin - sphere.centre
    squared_radius = sphere.radius * sphere.radius
    height = dot(f, f) - squared_radius  # power of the origin: its height above the surface times a length
    approach = -dot(f, direction)
    g = f + approach * direction  # from the centre to the closest approach
    squared_half = squared_radius - dot(g, g)  # of half of the chord
    leaving = (approach <= 0.0) & (height > ROUNDING * unit_roundoff(height) * squared_radius)
    close = fabs(height) <= CLOSE * squared_radius
    hit = ((squared_half >= 0.0) | close) & ~leaving
    t = approach
    if any(hit):
        close = hit & close
        product = squared_half  # of the distances to both hits, for close origins; without a use for others
        if rarely(close):
            power, product = exact_power(splat(sphere.centre, t), splat(sphere.radius, t), splat(origin, t))
            squared_half = where(close, approach * approach - power, squared_half)
        half = sqrt(squared_half)
        near = approach - half
        far = approach + half
        if rarely(close):
            near = where(close & (approach > 0.0), product / far, near)
            far = where(close & (approach <= 0.0), product / near, far)
        least = splat(0.0, t)
        if limit is None:  # a hit that is nearer than the start is known is the start, also on tiny spheres
            least = position_error(origin, f)
        t = where(near > least, near, far)
        hit = hit & (t > least)  # NaN where there is no chord
    return hit, t


@outlined
def exact_power(centre: Vec, radius: Number, origin: Vec) -> tuple[Number, Number]:
    """Compute the power of an origin without cancellation; the second one is exactly 0 for an origin on the sphere."""
    f = offset(origin, centre)
    power = value(minus(scalar_product(f, f), square_of(radius, radius)))
    return power, zero_within(power, 2.0 * radius * position_error(origin, origin - centre))


def surface(sphere: PackedSphere, point: Vec) -> tuple[Vec, Vec]:
    """The point of the sphere nearest to `point`, and the outward normal there."""
    normal = unit(point - sphere.centre)
    return sphere.centre + sphere.radius * normal, normal


def mapping(sphere: PackedSphere, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """Longitude as u and latitude as v, each from 0 to 1. At the poles the tangents are zero."""
    rho = sqrt(normal.x * normal.x + normal.z * normal.z)
    per_rho = 1.0 / where(rho == 0.0, 1.0, rho)
    half = 0.5 * TWO_PI * sphere.radius
    fall = -normal.y * per_rho
    u, v = 0.5 + angle_in_turns(-normal.x, -normal.z), 0.5 + 2.0 * angle_in_turns(normal.y, rho)
    along_u = 2.0 * half * Vec(normal.z, 0.0, -normal.x)
    along_v = half * Vec(fall * normal.x, rho, fall * normal.z)
    return u, v, along_u, along_v


def boundary(sphere: Any, point: Vec) -> Boundary:
    """Distance from the surface."""
    return Boundary((length(point - sphere.centre) - sphere.diameter / 2,))
