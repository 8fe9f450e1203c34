"""Cylinder: |(p - centre) x axis|^2 <= radius^2, between two planes across the axis."""

from typing import Any

from gmpy2 import mpfr

from minirt.shapes.cylinder import Cylinder
from tests.oracle.body import Body, body
from tests.oracle.vectors import Vector, cross, dot, exact, minus, unit


@body.register
def _(cylinder: Cylinder, swell: Any = 0) -> Body:
    centre, axis = exact(cylinder.centre), unit(cylinder.axis)
    radius, half = mpfr(cylinder.diameter) / 2 + swell, mpfr(cylinder.height) / 2 + swell

    def side(p: Vector) -> Any:
        across = cross(minus(p, centre), axis)
        return dot(across, across) - radius**2

    def height(p: Vector) -> Any:
        return dot(minus(p, centre), axis)

    return Body((side, lambda p: height(p) - half, lambda p: -height(p) - half))
