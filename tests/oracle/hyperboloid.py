"""Hyperboloid: |p x axis|^2 <= waist^2 + slope^2 (p . axis)^2 for points p from the centre, between two planes across
the axis."""

from typing import Any

from gmpy2 import mpfr

from minirt.shapes.hyperboloid import Hyperboloid
from tests.oracle.body import Body, body
from tests.oracle.vectors import Vector, cross, dot, exact, minus, unit


@body.register
def _(hyperboloid: Hyperboloid, swell: Any = 0) -> Body:
    centre, axis = exact(hyperboloid.centre), unit(hyperboloid.axis)
    waist, radius, half = (mpfr(x) / 2 for x in (hyperboloid.waist, hyperboloid.diameter, hyperboloid.height))
    slope = (radius**2 - waist**2) / half**2  # squared
    more = 2 * radius * swell  # moves the side by at least `swell`, everywhere

    def height(p: Vector) -> Any:
        return dot(minus(p, centre), axis)

    def side(p: Vector) -> Any:
        across = cross(minus(p, centre), axis)
        return dot(across, across) - waist**2 - slope * height(p) ** 2 - more

    return Body((side, lambda p: height(p) - half - swell, lambda p: -height(p) - half - swell))
