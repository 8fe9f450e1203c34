"""Bodies: shapes as implicit functions, and their intersections with rays."""

from __future__ import annotations

from collections.abc import Callable
from functools import singledispatch
from typing import Any, NamedTuple

from gmpy2 import mpfr, sqrt

from minirt.shapes import Shape
from tests.oracle.polynomial import Polynomial
from tests.oracle.vectors import Vector, dot, exact, unit

Implicit = Callable[[Vector], Any]  # a polynomial of the coordinates of a point, made by + - * ** and vector functions


class Body(NamedTuple):
    """A solid or a sheet, bounded by implicit surfaces F = 0.

    A solid is where all `walls` are <= 0; its surface is where one of them is 0. A sheet, which has no inside, is where
    its one wall is 0. Both are cut off, without a surface there, where one of the `clips` is > 0. The normal points to
    where the wall grows.
    """

    walls: tuple[Implicit, ...]
    clips: tuple[Implicit, ...] = ()
    solid: bool = True


@singledispatch
def body(shape: Shape, swell: Any = 0) -> Body:
    """The body of a shape, its surface moved outwards by `swell`; of a sheet only its edges are moved."""
    path = file_of(type(shape)).replace(".", "/")
    raise TypeError(f"the oracle knows no {shape.title}: write its body into {path}.py, as tests/oracle/sphere.py does")


def file_of(shape: type[Shape]) -> str:
    """The module of this folder that registers the body of a kind of shape: it is named as the shape's own."""
    return f"{__package__}.{shape.__module__.rpartition('.')[2]}"


def crossings(each: Body, origin: Vector, direction: Vector) -> list[mpfr]:
    """All t at which the line origin + t direction meets the surface, in ascending order."""
    ray = [Polynomial(o, d) for o, d in zip(exact(origin), exact(direction), strict=True)]
    walls = [as_polynomial(wall(ray)) for wall in each.walls]
    clips = [as_polynomial(clip(ray)) for clip in each.clips]
    hits: list[mpfr] = []
    for wall in walls:
        others = [*clips, *(other for other in walls if other is not wall and each.solid)]
        hits += [t for t in wall.roots() if all(other(t) <= 0 for other in others)]
    return sorted(hits)


def meetings(each: Body, origin: Vector, direction: Vector) -> list[mpfr]:
    """All t at which the line meets one of the walls, also where that is cut off or beyond another one."""
    ray = [Polynomial(o, d) for o, d in zip(exact(origin), exact(direction), strict=True)]
    return [t for wall in each.walls for t in as_polynomial(wall(ray)).roots()]


def inside(each: Body, point: Vector) -> bool:
    """Whether a point is inside, not on the surface and not cut off; a sheet has no inside."""
    p = exact(point)
    return each.solid and all(wall(p) < 0 for wall in each.walls) and all(clip(p) <= 0 for clip in each.clips)


def normals(each: Body, point: Vector) -> list[tuple[mpfr, Vector]]:
    """The distance of a point to each wall, to first order, and its outward unit normal there; the nearest first."""
    p = exact(point)
    slopes = [(abs(wall(p)), gradient(wall, p)) for wall in each.walls]
    return sorted(((height / sqrt(dot(slope, slope)), unit(slope)) for height, slope in slopes), key=lambda w: w[0])


def gradient(wall: Implicit, point: Vector) -> Vector:
    """The gradient of a wall: its slope along an axis is the coefficient of t of the polynomial along that axis."""
    axes = ([Polynomial(x, int(i == axis)) for i, x in enumerate(point)] for axis in range(3))
    return [([*as_polynomial(wall(line)).coefficients, mpfr(0)])[1] for line in axes]


def as_polynomial(value: Any) -> Polynomial:
    return value if isinstance(value, Polynomial) else Polynomial(value)
