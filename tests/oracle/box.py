"""Box: between three pairs of planes, perpendicular to its own axes."""

from typing import Any

from gmpy2 import mpfr

from minirt.shapes.box import Box
from tests.oracle.body import Body, Implicit, body
from tests.oracle.vectors import Vector, dot, exact, minus, own_axes


@body.register
def _(box: Box, swell: Any = 0) -> Body:
    centre = exact(box.centre)

    def face(axis: Vector, half: Any) -> Implicit:
        return lambda p: dot(minus(p, centre), axis) - half - swell

    halves = [mpfr(size) / 2 for size in box.sizes]
    pairs = [(v, h) for v, h in zip(own_axes(box.axis, box.roll), halves, strict=True)]
    return Body(tuple(face([side * x for x in v], h) for v, h in pairs for side in (1, -1)))
