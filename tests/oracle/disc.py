"""Disc: (p - centre) . normal = 0 within a radius; a sheet."""

from typing import Any

from gmpy2 import mpfr

from minirt.shapes.disc import Disc
from tests.oracle.body import Body, body
from tests.oracle.vectors import Vector, dot, exact, minus, unit


@body.register
def _(disc: Disc, swell: Any = 0) -> Body:
    centre, normal, radius = exact(disc.centre), unit(disc.normal), mpfr(disc.diameter) / 2 + swell

    def beyond(p: Vector) -> Any:
        out = minus(p, centre)
        return dot(out, out) - radius * abs(radius)

    return Body((lambda p: dot(minus(p, centre), normal),), (beyond,), solid=False)
