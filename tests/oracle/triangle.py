"""Triangle: (p - a) . normal = 0, on the inner side of the three edges; a sheet."""

from typing import Any

from minirt.shapes.triangle import Triangle
from tests.oracle.body import Body, Implicit, body
from tests.oracle.vectors import Vector, cross, dot, exact, minus, unit


@body.register
def _(triangle: Triangle, swell: Any = 0) -> Body:
    a, b, c = corners = [exact(corner) for corner in (triangle.a, triangle.b, triangle.c)]
    normal = unit(cross(minus(b, a), minus(c, a)))

    def beyond(start: Vector, end: Vector) -> Implicit:
        out = unit(cross(minus(end, start), normal))
        return lambda p: dot(minus(p, start), out) - swell

    clips = tuple(beyond(corners[i], corners[(i + 1) % 3]) for i in range(3))
    return Body((lambda p: dot(minus(p, a), normal),), clips, solid=False)
