"""Paraboloid: |p x axis|^2 height <= radius^2 (p . axis) for points p from the vertex, and below the rim."""

from typing import Any

from gmpy2 import mpfr

from minirt.shapes.paraboloid import Paraboloid
from tests.oracle.body import Body, body
from tests.oracle.vectors import Vector, cross, dot, exact, minus, unit


@body.register
def _(paraboloid: Paraboloid, swell: Any = 0) -> Body:
    vertex, axis = exact(paraboloid.vertex), unit(paraboloid.axis)
    radius, rim = mpfr(paraboloid.diameter) / 2, mpfr(paraboloid.height)
    more = 2 * radius * swell + radius**2 / rim * swell  # moves the side by at least `swell`, everywhere

    def height(p: Vector) -> Any:
        return dot(minus(p, vertex), axis)

    def side(p: Vector) -> Any:
        across = cross(minus(p, vertex), axis)
        return dot(across, across) - radius**2 / rim * height(p) - more

    return Body((side, lambda p: height(p) - rim - swell))
