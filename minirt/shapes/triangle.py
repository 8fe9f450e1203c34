"""Triangle: `tr x,y,z x,y,z x,y,z R,G,B`.

The flat surface between three corners, seen from both sides. Its normal points to where the corners are seen in
counter-clockwise order. Triangles that share corners have no gap between them. The lower left half of a picture lies
on it: its lower left corner on the first corner, the lower right one on the second, the upper left one on the third.

    tr -2,0,20  2,0,20  0,3,20  90,160,220    a sail two units up and down
"""

from __future__ import annotations

from math import hypot
from typing import Any, NamedTuple

from minirt.fields import Colour, Point, Triple, declare, unit
from minirt.lanes import (
    Mask,
    Number,
    Vec,
    any,
    cross,
    dot,
    fabs,
    max_norm,
    maximum,
    minimum,
    rarely,
    rounded_product,
    splat,
    sqrt,
    unit_roundoff,
    where,
)
from minirt.records import record
from minirt.shapes import boundary as exact
from minirt.shapes.boundary import Boundary
from minirt.shapes.compensated import position_error
from minirt.shapes.plane_normals import plane_normal
from minirt.shapes.shape import Ball, Hit, Position, Shape

GRAZING = 2.0**-13  # a hit is clamped to the triangle if the slope of the ray, times the share to an edge, is less
ROUNDINGS = 1.5  # by which a ray that hits a triangle may pass beside it
APART = 256  # roundings of its length by which a ray may miss the apex, or a side plane of the pyramid
BEHIND = 4  # roundings of the coordinates by which a start may seem to lie behind the triangle
FLAT = 16 * 2.0**-53  # least height of a triangle, as a share of its largest coordinate


@record()
class Triangle(Shape):
    """A line `tr` of a scene file."""

    code, title, plural, aliases, solid = "tr", "triangle", "triangles", ("tri",), False
    a: Triple = declare(Point, "a corner")
    b: Triple = declare(Point, "the next corner")
    c: Triple = declare(Point, "the last corner")
    colour: Triple = declare(Colour, "colour")

    def edges(self) -> list[Triple]:
        """The vectors from each corner to the next."""
        pairs = ((self.a, self.b), (self.b, self.c), (self.c, self.a))
        return [(x - u, y - v, z - w) for (u, v, w), (x, y, z) in pairs]

    def conflict(self) -> tuple[str, str] | None:
        first, second, _ = edges = self.edges()
        longest = max(hypot(*edge) for edge in edges)
        largest = max(abs(part) for corner in (self.a, self.b, self.c) for part in corner)
        area = cross(Vec(*first), Vec(*second))
        if hypot(area.x, area.y, area.z) > FLAT * largest * longest:
            return None
        return "c", "must not lie on a line with a and b"

    def normal(self) -> Triple:
        """The unit normal, exact to a few roundings for slivers too."""
        normal = plane_normal(Vec(*self.a), Vec(*self.b), Vec(*self.c))
        return unit((normal.x, normal.y, normal.z))

    def pack(self) -> PackedTriangle:
        a, b, c = (Position(Vec(*corner)) for corner in (self.a, self.b, self.c))
        return PackedTriangle(a, b, c, Vec(*self.normal()))

    def balls(self) -> tuple[Ball, ...]:
        return (self.a, 0.0), (self.b, 0.0), (self.c, 0.0)


class PackedTriangle(NamedTuple):
    """Packed form of a triangle."""

    a: Position
    b: Position
    c: Position
    normal: Vec


def intersect(triangle: Any, origin: Vec, direction: Vec, limit: Number | None = None) -> Hit:
    """Whether a ray meets the triangle, or one of a mesh, and the t > 0 at which it does; `limit` as in
    `minirt.shapes.shape`. There are no gaps between neighbours.

    Woop, Benthin and Wald, Watertight Ray/Triangle Intersection (2013): seen along the ray, its origin lies on the same
    side of all three edges. The side depends on the two ends of an edge alone, transformed alike for all triangles that
    share it, and on an edge function that only changes its sign with the order of the ends. So a ray towards a shared
    edge or corner hits at least one of the triangles. Nothing here may round differently for one of them: products are
    rounded by themselves, never fused with the sum that follows.

    The distance is that to the plane of the triangle. The mean of the corners, weighted by the edge functions, would be
    off by roundings of the square of the longest edge over the height: for slivers, far too much. The hit of a grazing
    ray is clamped to the triangle, even if the ray is parallel to the plane. A ray that starts on the plane, within
    rounding, does not hit it.
    """
    x, y, z = fabs(direction.x), fabs(direction.y), fabs(direction.z)
    by_x = (x >= y) & (x >= z)
    by_y = (y >= z) & ~by_x
    d = permuted_axes(by_x, by_y, direction)
    per_depth = 1.0 / d.z
    shear = Vec(d.x * per_depth, d.y * per_depth, per_depth)
    a = sheared(shear, permuted_axes(by_x, by_y, triangle.a - origin))
    b = sheared(shear, permuted_axes(by_x, by_y, triangle.b - origin))
    c = sheared(shear, permuted_axes(by_x, by_y, triangle.c - origin))
    of_a = edge_function(b, c)
    of_b = edge_function(c, a)
    of_c = edge_function(a, b)
    least = minimum(minimum(of_a, of_b), of_c)
    most = maximum(maximum(of_a, of_b), of_c)
    hit = (least >= 0.0) | (most <= 0.0)
    t = a.z
    if any(hit):
        f = origin - triangle.a  # not its opposite: kept from above, that costs registers
        slope, height = dot(triangle.normal, direction), dot(triangle.normal, f)
        t = -height / slope
        extent, edge = fabs(least + most), minimum(fabs(least), fabs(most))
        grazing = fabs(slope) * edge <= GRAZING * extent
        if rarely(hit & grazing):
            enter, leave = above(triangle, origin, direction)
            at_a, at_b, at_c = a.z * per_depth, b.z * per_depth, c.z * per_depth
            begin = maximum(enter, minimum(minimum(at_a, at_b), at_c))
            end = minimum(leave, maximum(maximum(at_a, at_b), at_c))
            t = where(grazing, minimum(maximum(t, begin), end), t)  # `begin` where t is NaN
            hit = hit & ~(grazing & (enter > leave)) & (extent != 0.0)  # not one that is seen edge on
        if limit is None:
            hit = hit & (fabs(height) > position_error(origin, f))
        hit = hit & (t > 0.0)
    return hit, t


def above(triangle: Any, origin: Vec, direction: Vec) -> tuple[Number, Number]:
    """Where a ray begins and ends to be above or below the triangle, for all that rounding lets one know.

    There it is between each edge and the line through the opposite corner. That is symmetrical: the normal may be on
    either side.
    """
    a, b, c, normal = triangle.a - origin, triangle.b - origin, triangle.c - origin, triangle.normal
    pad = ROUNDINGS * unit_roundoff(a.x) * (length(a) + length(b) + length(c))
    first, second = between(a, b, c, normal, direction, pad), between(b, c, a, normal, direction, pad)
    third = between(c, a, b, normal, direction, pad)
    return maximum(maximum(first[0], second[0]), third[0]), minimum(minimum(first[1], second[1]), third[1])


def between(p: Vec, q: Vec, r: Vec, normal: Vec, direction: Vec, pad: Number) -> tuple[Number, Number]:
    """Where a ray from 0 enters and leaves the strip between the edge from p to q and the corner r."""
    edge = q - p
    across = cross(edge, normal)
    margin, rate = pad * length(edge), dot(across, direction)
    at_edge, at_corner = dot(across, p), dot(across, r)
    one = (minimum(at_edge, at_corner) - margin) / rate
    other = (maximum(at_edge, at_corner) + margin) / rate
    return minimum(one, other), maximum(one, other)


def length(v: Vec) -> Number:
    """The length of a vector."""
    return sqrt(dot(v, v))


def permuted_axes(by_x: Mask, by_y: Mask, v: Vec) -> Vec:
    """Swap the z axis with x where `by_x` holds, and with y where `by_y` holds."""
    return Vec(where(by_x, v.z, v.x), where(by_y, v.z, v.y), where(by_x, v.x, where(by_y, v.y, v.z)))


def sheared(shear: Vec, v: Vec) -> Vec:
    """Shear a point so that the ray is the z axis: its place as seen along the ray, and its depth."""
    return Vec(v.x - rounded_product(shear.x, v.z), v.y - rounded_product(shear.y, v.z), v.z)


def edge_function(p: Vec, q: Vec) -> Number:
    """Twice the signed area of the triangle of two points and the origin in x and y; the sign is exact, or it is 0."""
    return rounded_product(p.x, q.y) - rounded_product(p.y, q.x)


def surface(triangle: Any, point: Vec) -> tuple[Vec, Vec]:
    """`point` projected onto the triangle's plane, and the normal."""
    height = dot(triangle.normal, point - triangle.a)
    return point - height * triangle.normal, triangle.normal


def mapping(triangle: PackedTriangle, point: Vec, normal: Vec) -> tuple[Number, Number, Vec, Vec]:
    """Barycentric coordinates of the second and third corner as u and v (Moller and Trumbore, Fast, Minimum Storage
    Ray/Triangle Intersection, 1997)."""
    p, to_b, to_c = point - triangle.a, triangle.b - triangle.a, triangle.c - triangle.a
    per_area = 1.0 / dot(cross(to_b, to_c), triangle.normal)
    u, v = dot(cross(p, to_c), triangle.normal), dot(cross(to_b, p), triangle.normal)
    return u * per_area, v * per_area, to_b, to_c


def boundary(triangle: Any, point: Vec) -> Boundary:
    """Height above the triangle, and distances beyond its edges."""
    a, b, c = triangle.a, triangle.b, triangle.c
    normal = exact.unit(cross(b - a, c - a))
    edges = tuple(dot(exact.unit(cross(end - start, normal)), point - start) for start, end in ((a, b), (b, c), (c, a)))
    return Boundary((dot(normal, point - a),), edges)


# Culling for packets of rays with a common point, by the pyramid between that point and the triangle. The side planes
# of the pyramid are the same for all rays of a packet. So this test takes half of the time of an intersection, and in
# a mesh with triangles as small as pixels nearly every triangle that passes it is hit.


def may_meet(triangle: Any, apex: Vec, start: Vec | None, direction: Vec, active: Mask) -> Mask:
    """Return the mask of the `active` rays without those that cannot hit the triangle, whatever the rounding.

    Without a `start` rays leave the apex. With one they lead to the apex, and those that start in front of the
    triangle, as seen from the apex, cannot hit it. A ray may hit if it lies on the same side of all three planes
    through the apex and an edge, within a margin.
    """
    a, b, c = triangle.a - apex, triangle.b - apex, triangle.c - apex
    ab, bc, ca = triangle.b - triangle.a, triangle.c - triangle.b, triangle.a - triangle.c
    far = splat(maximum(maximum(max_norm(a), max_norm(b)), max_norm(c)), direction.x)
    if start is not None:
        far = far + max_norm(apex - start)
        active = active & (depth_behind_plane(triangle, dot(triangle.normal, a), start) >= 0.0)
    if any(active):
        of_a, of_b, of_c = dot(cross(b, bc), direction), dot(cross(c, ca), direction), dot(cross(a, ab), direction)
        margin = APART * unit_roundoff(direction.x) * maximum(max_norm(ab), max_norm(ca)) * far
        least, most = minimum(minimum(of_a, of_b), of_c), maximum(maximum(of_a, of_b), of_c)
        active = active & ((least >= -margin) | (most <= margin))
    return active


def depth_behind_plane(triangle: Any, height: Number, start: Vec) -> Number:
    """The greatest depth of `start` behind the plane of a triangle, as seen from an apex at this `height` below it."""
    away = where(height > 0.0, splat(1.0, height), -1.0)
    slack = BEHIND * unit_roundoff(start.x) * (max_norm(start) + max_norm(triangle.a))
    return away * dot(triangle.normal, start - triangle.a) + slack
