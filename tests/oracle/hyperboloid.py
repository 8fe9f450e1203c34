"""Hyperboloid: |p x axis|^2 <= waist^2 + slope^2 (p . axis)^2 for points p from the centre, between two planes across
the axis."""

from typing import Any

from gmpy2 import mpfr, sqrt

from minirt.shapes.hyperboloid import Hyperboloid
from tests.oracle.body import Body, body
from tests.oracle.vectors import Vector, cross, dot, exact, minus, unit


@body.register
def _(hyperboloid: Hyperboloid, swell: Any = 0) -> Body:
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
