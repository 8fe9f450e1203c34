"""Exact hit distances to 60 digits, in the decimal arithmetic of the standard library.

The numbers of ray and shape are taken as they are, to the last bit; only axes and normals, which should have unit
length, are normalised. Every shape is an intersection of solids of revolution, mostly of one. A point at height h along
the axis and at distance d from it is inside if d^2 <= square + linear h + quadratic h^2 and low <= h <= high. A flat
shape is a solid without thickness.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from decimal import Context, Decimal, localcontext
from functools import reduce
from typing import Any, NamedTuple

from minirt.shapes import Shape
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
from minirt.shapes.triangle import Triangle

Exact = list[Decimal]  # a vector
Intervals = list[tuple[Decimal, Decimal]]
DIGITS = Context(prec=60)
END, ZERO = Decimal("Infinity"), Decimal(0)


class Solid(NamedTuple):
    """A solid of revolution; with `square` None it has no side and is bounded by low and high alone."""

    place: Exact
    axis: Exact  # of unit length
    square: Decimal | None = ZERO
    linear: Decimal = ZERO
    quadratic: Decimal = ZERO
    low: Decimal = -END
    high: Decimal = END
    scaled: tuple[Exact, ...] = ()  # rows of a matrix: the solid is where that takes a point into the one described


def plane(shape: Any, _: Decimal) -> Solid:
    """The half-space below a plane; a plane has no thickness that could grow."""
    return Solid(exact(shape.point), unit(exact(shape.normal)), square=None, high=ZERO)


def sphere(shape: Any, swell: Decimal) -> Solid:
    """d^2 <= r^2 - h^2."""
    radius = Decimal(shape.diameter) / 2 + swell
    return Solid(exact(shape.centre), exact((0, 0, 1)), radius * abs(radius), quadratic=Decimal(-1))


def cylinder(shape: Any, swell: Decimal) -> Solid:
    """d^2 <= r^2, between both caps."""
    radius, half = Decimal(shape.diameter) / 2 + swell, Decimal(shape.height) / 2 + swell
    return Solid(exact(shape.centre), unit(exact(shape.axis)), radius * abs(radius), low=-half, high=half)


def cone(shape: Any, swell: Decimal) -> Solid:
    """d <= slope h below the base; a cone that is thicker by `swell` has its apex further back."""
    axis, slope = unit(exact(shape.axis)), Decimal(shape.diameter) / 2 / Decimal(shape.height)
    back = swell * (1 + slope * slope).sqrt() / slope
    apex = [x - back * a for x, a in zip(exact(shape.apex), axis, strict=True)]
    high = Decimal(shape.height) + back + swell
    return Solid(apex, axis, quadratic=slope * slope, low=ZERO, high=high)


def paraboloid(shape: Any, swell: Decimal) -> Solid:
    """d^2 <= r^2 h / height below the rim; the side moves by at least `swell`."""
    radius, height = Decimal(shape.diameter) / 2, Decimal(shape.height)
    linear = radius * radius / height
    square = (2 * radius + linear) * swell
    return Solid(exact(shape.vertex), unit(exact(shape.axis)), square, linear, high=height + swell)


def hyperboloid(shape: Any, swell: Decimal) -> Solid:
    """d^2 <= waist^2 + slope h^2 between both caps; the side moves by at least `swell`."""
    waist, radius, half = (Decimal(each) / 2 for each in (shape.waist, shape.diameter, shape.height))
    slope = (radius * radius - waist * waist) / (half * half)
    mean = (waist * (radius * radius + slope * half * slope * half).sqrt()).sqrt()  # of the gradient's halves
    square = waist * waist + swell * (waist * waist / mean + mean)
    bend = slope + swell * (slope + slope * slope) / mean
    axis, end = unit(exact(shape.axis)), half + swell
    return Solid(exact(shape.centre), axis, square, quadratic=bend, low=-end, high=end)


def disc(shape: Any, swell: Decimal) -> Solid:
    """d^2 <= r^2 where h is 0."""
    radius = Decimal(shape.diameter) / 2 + swell
    return Solid(exact(shape.centre), unit(exact(shape.normal)), radius * abs(radius), low=ZERO, high=ZERO)


def square(shape: Any, swell: Decimal) -> tuple[Solid, ...]:
    """The plane of the square, cut by a slab along each of its two edges."""
    centre, normal, half = exact(shape.centre), unit(exact(shape.normal)), Decimal(shape.side) / 2 + swell
    level = cross(exact((0, 1, 0)), normal)
    right = unit(level) if any(level) else exact((1, 0, 0))
    return slab(centre, normal, ZERO, ZERO), *(slab(centre, w, -half, half) for w in (right, cross(normal, right)))


def triangle(shape: Any, swell: Decimal) -> tuple[Solid, ...]:
    """The plane of the triangle, cut by a half-space at each of its three edges."""
    corners = [exact(corner) for corner in (shape.a, shape.b, shape.c)]
    edges = [minus(corners[i - 2], corners[i]) for i in range(3)]
    normal = unit(cross(edges[0], edges[1]))
    sides = (slab(p, unit(cross(edge, normal)), -END, swell) for p, edge in zip(corners, edges, strict=True))
    return slab(corners[0], normal, ZERO, ZERO), *sides


def box(shape: Any, swell: Decimal) -> tuple[Solid, ...]:
    """Three slabs, half a size to both sides of the centre along each axis of the box."""
    centre, halves = exact(shape.centre), (Decimal(size) / 2 + swell for size in shape.sizes)
    return tuple(slab(centre, axis, -half, half) for axis, half in zip(own_axes(shape), halves, strict=True))


def ellipsoid(shape: Any, swell: Decimal) -> Solid:
    """The unit sphere, scaled along the axes of the ellipsoid by its semi-axes."""
    halves = (Decimal(size) / 2 + swell for size in shape.sizes)
    rows = ([each / half for each in axis] for axis, half in zip(own_axes(shape), halves, strict=True))
    return Solid(exact(shape.centre), exact((0, 0, 1)), Decimal(1), quadratic=Decimal(-1), scaled=tuple(rows))


def own_axes(shape: Any) -> tuple[Exact, Exact, Exact]:
    """The own x, y and z axes of a shape whose y axis is its `axis`: half a turn about the bisector of that and the
    scene's y, or its opposite, takes the axes of the scene to them, or to their opposites."""
    y = unit(exact(shape.axis))
    bisector = [y[0], y[1] + (1 if y[1] >= 0 else -1), y[2]]
    share = [2 * each / dot(bisector, bisector) for each in bisector]
    x, z = ([share[i] * part - int(i == j) for j, part in enumerate(bisector)] for i in (0, 2))
    return x, y, z


def slab(place: Exact, axis: Exact, low: Decimal, high: Decimal) -> Solid:
    """The slab between two heights along an axis."""
    return Solid(place, axis, square=None, low=low, high=high)


SOLIDS: dict[type[Shape], Callable[[Any, Decimal], Solid | tuple[Solid, ...]]] = {
    Plane: plane,
    Sphere: sphere,
    Cylinder: cylinder,
    Cone: cone,
    Paraboloid: paraboloid,
    Hyperboloid: hyperboloid,
    Triangle: triangle,
    Square: square,
    Disc: disc,
    Box: box,
    Ellipsoid: ellipsoid,
}


def distance(shape: Shape, origin: Sequence[float], direction: Sequence[float], swell: float = 0.0) -> Decimal:
    """Return the least t > 0 at which origin + t direction lies on the surface, or infinity.

    The surface of a solid, or the edge of a flat shape, is moved outwards by `swell`: an answer in fewer digits is
    right if it lies between those for a slightly larger and a slightly smaller shape. KeyError for a shape that is not
    in `SOLIDS`.
    """
    with localcontext(DIGITS):
        found = SOLIDS[type(shape)](shape, Decimal(swell))
        solids = (found,) if isinstance(found, Solid) else found
        inside = reduce(intersection, (inside_intervals(solid, exact(origin), exact(direction)) for solid in solids))
        return min((t for interval in inside for t in interval if t > 0), default=END)


def inside_intervals(solid: Solid, origin: Exact, direction: Exact) -> Intervals:
    """Return the intervals of t in which a line is inside a solid."""
    out = minus(origin, solid.place)
    if solid.scaled:
        out, direction = ([dot(row, each) for row in solid.scaled] for each in (out, direction))
    height, climb = dot(out, solid.axis), dot(direction, solid.axis)
    within = intersection(not_above(climb, height - solid.high), not_above(-climb, solid.low - height))
    if solid.square is None:
        return within
    p, d = across(out, solid.axis, height), across(direction, solid.axis, climb)
    side = not_positive(
        dot(d, d) - solid.quadratic * climb * climb,
        dot(p, d) - (solid.linear / 2 + solid.quadratic * height) * climb,
        dot(p, p) - solid.square - (solid.linear + solid.quadratic * height) * height,
    )
    return intersection(side, within)


def not_positive(a: Decimal, b: Decimal, c: Decimal) -> Intervals:
    """Return the intervals of t in which a t^2 + 2 b t + c <= 0."""
    if a == 0:
        return not_above(2 * b, c)
    square = b * b - a * c
    if square < 0:
        return [] if a > 0 else [(-END, END)]
    low, high = sorted(((-b - square.sqrt()) / a, (-b + square.sqrt()) / a))
    return [(low, high)] if a > 0 else [(-END, low), (high, END)]


def not_above(slope: Decimal, start: Decimal) -> Intervals:
    """Return the interval of t in which start + t slope <= 0."""
    if slope == 0 or start.is_infinite():
        return [(-END, END)] if start <= 0 else []
    return [(-END, -start / slope)] if slope > 0 else [(-start / slope, END)]


def intersection(some: Intervals, others: Intervals) -> Intervals:
    """Intersect two lists of intervals."""
    found = [(max(a, c), min(b, d)) for a, b in some for c, d in others]
    return [(start, end) for start, end in found if start <= end]


def exact(numbers: Sequence[float]) -> Exact:
    """Convert floats to decimals, exactly."""
    return [Decimal(float(number)) for number in numbers]


def dot(a: Exact, b: Exact) -> Decimal:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def minus(a: Exact, b: Exact) -> Exact:
    """a - b."""
    return [x - y for x, y in zip(a, b, strict=True)]


def cross(a: Exact, b: Exact) -> Exact:
    """Vector product."""
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def unit(v: Exact) -> Exact:
    """v, scaled to length 1."""
    length = dot(v, v).sqrt()
    return [x / length for x in v]


def across(v: Exact, axis: Exact, along: Decimal) -> Exact:
    """Return the part of v that is perpendicular to the axis; `along` is its component along the axis."""
    return [x - along * y for x, y in zip(v, axis, strict=True)]
