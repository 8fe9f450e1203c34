"""Bodies of all shapes: their implicit functions."""

from __future__ import annotations

from typing import Any

from gmpy2 import mpfr, sqrt

from minirt.shapes.box import Box
from minirt.shapes.cone import Cone
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.disc import Disc
from minirt.shapes.ellipsoid import Ellipsoid
from minirt.shapes.hyperboloid import Hyperboloid
from minirt.shapes.paraboloid import Paraboloid
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from minirt.shapes.square import Square
from minirt.shapes.torus import Torus
from minirt.shapes.triangle import Triangle
from tests.oracle.body import Body, Implicit, Vector, body, cross, dot, exact, minus, own_axes, rolled, unit


@body.register
def _sphere(sphere: Sphere, swell: Any = 0) -> Body:
    """|p - centre|^2 <= radius^2."""
    centre, radius = exact(sphere.centre), mpfr(sphere.diameter) / 2 + swell

    def ball(p: Vector) -> Any:
        out = minus(p, centre)
        return dot(out, out) - radius**2

    return Body((ball,))


@body.register
def _plane(plane: Plane, _swell: Any = 0) -> Body:
    """(p - point) . normal = 0; a sheet without an edge."""
    point, normal = exact(plane.point), unit(plane.normal)
    return Body((lambda p: dot(minus(p, point), normal),), solid=False)


@body.register
def _cylinder(cylinder: Cylinder, swell: Any = 0) -> Body:
    """|(p - centre) x axis|^2 <= radius^2, between two planes across the axis."""
    centre, axis = exact(cylinder.centre), unit(cylinder.axis)
    radius, half = mpfr(cylinder.diameter) / 2 + swell, mpfr(cylinder.height) / 2 + swell

    def side(p: Vector) -> Any:
        across = cross(minus(p, centre), axis)
        return dot(across, across) - radius**2

    def height(p: Vector) -> Any:
        return dot(minus(p, centre), axis)

    return Body((side, lambda p: height(p) - half, lambda p: -height(p) - half))


@body.register
def _cone(cone: Cone, swell: Any = 0) -> Body:
    """|p x axis|^2 <= slope^2 (p . axis)^2 for points p from the apex on the side of the base, and below that."""
    axis, slope = unit(cone.axis), mpfr(cone.diameter) / 2 / mpfr(cone.height)
    back = swell * sqrt(1 + slope**2) / slope  # a cone around the cone at that distance has its apex so far behind
    tip = mpfr(cone.height) / 2**80  # of the other nappe: a root at the apex itself is not lost to rounding
    apex = [x - back * a for x, a in zip(exact(cone.apex), axis, strict=True)]

    def height(p: Vector) -> Any:
        return dot(minus(p, apex), axis)

    def side(p: Vector) -> Any:
        across = cross(minus(p, apex), axis)
        return dot(across, across) - slope**2 * height(p) ** 2

    return Body((side, lambda p: height(p) - back - cone.height - swell), (lambda p: -height(p) - tip,))


@body.register
def _paraboloid(paraboloid: Paraboloid, swell: Any = 0) -> Body:
    """|p x axis|^2 height <= radius^2 (p . axis) for points p from the vertex, and below the rim."""
    vertex, axis = exact(paraboloid.vertex), unit(paraboloid.axis)
    radius, rim = mpfr(paraboloid.diameter) / 2, mpfr(paraboloid.height)
    more = 2 * radius * swell + radius**2 / rim * swell  # moves the side by at least `swell`, everywhere

    def height(p: Vector) -> Any:
        return dot(minus(p, vertex), axis)

    def side(p: Vector) -> Any:
        across = cross(minus(p, vertex), axis)
        return dot(across, across) - radius**2 / rim * height(p) - more

    return Body((side, lambda p: height(p) - rim - swell))


@body.register
def _hyperboloid(hyperboloid: Hyperboloid, swell: Any = 0) -> Body:
    """|p x axis|^2 <= waist^2 + slope^2 (p . axis)^2 for points p from the centre, between two planes."""
    centre, axis = exact(hyperboloid.centre), unit(hyperboloid.axis)
    waist, radius, half = (mpfr(x) / 2 for x in (hyperboloid.waist, hyperboloid.diameter, hyperboloid.height))
    slope = (radius**2 - waist**2) / half**2  # squared
    steepest = sqrt(radius**2 + (slope * half) ** 2)  # half of the gradient's length at the rim; at the waist: waist
    mean = sqrt(waist * steepest)

    def height(p: Vector) -> Any:
        return dot(minus(p, centre), axis)

    def side(p: Vector) -> Any:
        across, squared = cross(minus(p, centre), axis), height(p) ** 2
        gradient = waist**2 + (slope + slope**2) * squared  # square of half its length
        more = swell * (gradient * (1 / mean) + mean)  # at least 2 sqrt(gradient): the side moves by `swell` or more
        return dot(across, across) - waist**2 - slope * squared - more

    return Body((side, lambda p: height(p) - half - swell, lambda p: -height(p) - half - swell))


@body.register
def _triangle(triangle: Triangle, swell: Any = 0) -> Body:
    """(p - a) . normal = 0, on the inner side of the three edges; a sheet."""
    a, b, c = corners = [exact(corner) for corner in (triangle.a, triangle.b, triangle.c)]
    normal = unit(cross(minus(b, a), minus(c, a)))

    def beyond(start: Vector, end: Vector) -> Implicit:
        out = unit(cross(minus(end, start), normal))
        return lambda p: dot(minus(p, start), out) - swell

    clips = tuple(beyond(corners[i], corners[(i + 1) % 3]) for i in range(3))
    return Body((lambda p: dot(minus(p, a), normal),), clips, solid=False)


@body.register
def _square(square: Square, swell: Any = 0) -> Body:
    """(p - centre) . normal = 0 within half a side of two planes through the centre; a sheet."""
    centre, normal, half = exact(square.centre), unit(square.normal), mpfr(square.side) / 2 + swell
    level = cross(exact((0, 1, 0)), normal)
    right = unit(level) if any(level) else exact((1, 0, 0))
    right, up = rolled(right, cross(normal, right), square.roll)

    def within(axis: Vector) -> Any:
        return lambda p: dot(minus(p, centre), axis) ** 2 - half * abs(half)

    return Body((lambda p: dot(minus(p, centre), normal),), (within(right), within(up)), solid=False)


@body.register
def _disc(disc: Disc, swell: Any = 0) -> Body:
    """(p - centre) . normal = 0 within a radius; a sheet."""
    centre, normal, radius = exact(disc.centre), unit(disc.normal), mpfr(disc.diameter) / 2 + swell

    def beyond(p: Vector) -> Any:
        out = minus(p, centre)
        return dot(out, out) - radius * abs(radius)

    return Body((lambda p: dot(minus(p, centre), normal),), (beyond,), solid=False)


@body.register
def _box(box: Box, swell: Any = 0) -> Body:
    """Between three pairs of planes, perpendicular to its own axes."""
    centre = exact(box.centre)

    def face(axis: Vector, half: Any) -> Implicit:
        return lambda p: dot(minus(p, centre), axis) - half - swell

    halves = [mpfr(size) / 2 for size in box.sizes]
    pairs = [(v, h) for v, h in zip(own_axes(box.axis, box.roll), halves, strict=True)]
    return Body(tuple(face([side * x for x in v], h) for v, h in pairs for side in (1, -1)))


@body.register
def _torus(torus: Torus, swell: Any = 0) -> Body:
    """(|p|^2 + ring^2 - tube^2)^2 <= 4 ring^2 |p x axis|^2 for points p from the centre."""
    centre, axis = exact(torus.centre), unit(torus.axis)
    ring, tube = mpfr(torus.diameter) / 2, mpfr(torus.tube) / 2 + swell

    def wall(p: Vector) -> Any:
        out = minus(p, centre)
        across = cross(out, axis)
        return (dot(out, out) + ring**2 - tube**2) ** 2 - 4 * ring**2 * dot(across, across)

    return Body((wall,))


@body.register
def _ellipsoid(ellipsoid: Ellipsoid, swell: Any = 0) -> Body:
    """(p . x / a)^2 + (p . y / b)^2 + (p . z / c)^2 <= 1 for points p from the centre, and its own axes."""
    centre = exact(ellipsoid.centre)
    semi_axes = [mpfr(size) / 2 for size in ellipsoid.sizes]
    axes = list(zip(own_axes(ellipsoid.axis, ellipsoid.roll), semi_axes, strict=True))
    mean = 1 / sqrt(min(semi_axes) * max(semi_axes))  # of half the gradient's length on the surface

    def wall(p: Vector) -> Any:
        out = minus(p, centre)
        x, y, z = (dot(out, axis) * (1 / semi) for axis, semi in axes)
        gradient = sum((part * (1 / semi)) ** 2 for part, semi in zip((x, y, z), semi_axes, strict=True))
        more = swell * (gradient * (1 / mean) + mean)  # at least 2 sqrt(gradient): it moves by `swell` or more
        return x**2 + y**2 + z**2 - 1 - more

    return Body((wall,))
