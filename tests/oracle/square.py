"""Square: (p - centre) . normal = 0 within half a side of two planes through the centre; a sheet."""

from typing import Any

from gmpy2 import mpfr

from minirt.shapes.square import Square
from tests.oracle.body import Body, body
from tests.oracle.vectors import Vector, cross, dot, exact, minus, rolled, unit


@body.register
def _(square: Square, swell: Any = 0) -> Body:
    centre, normal, half = exact(square.centre), unit(square.normal), mpfr(square.side) / 2 + swell
    level = cross(exact((0, 1, 0)), normal)
    right = unit(level) if any(level) else exact((1, 0, 0))
    right, up = rolled(right, cross(normal, right), square.roll)

    def within(axis: Vector) -> Any:
        return lambda p: dot(minus(p, centre), axis) ** 2 - half * abs(half)

    return Body((lambda p: dot(minus(p, centre), normal),), (within(right), within(up)), solid=False)
