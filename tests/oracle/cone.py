"""Cone: |p x axis|^2 <= slope^2 (p . axis)^2 for points p from the apex on the side of the base, and below that."""

from typing import Any

from gmpy2 import mpfr, sqrt

from minirt.shapes.cone import Cone
from tests.oracle.body import Body, body
from tests.oracle.vectors import Vector, cross, dot, exact, minus, unit


@body.register
def _(cone: Cone, swell: Any = 0) -> Body:
    axis, slope = unit(cone.axis), mpfr(cone.diameter) / 2 / mpfr(cone.height)
    back = swell * sqrt(1 + slope**2) / slope  # a cone around the cone at that distance has its apex so far behind
    tip = mpfr(cone.height) / 2**80  # of the other nappe: a root at the apex itself is not lost to rounding
    apex = [x - back * a for x, a in zip(exact(cone.apex), axis, strict=True)]

    def height(p: Vector) -> Any:
        return dot(minus(p, apex), axis)

    def side(p: Vector) -> Any:
        across = cross(minus(p, apex), axis)
        return dot(across, across) - slope**2 * height(p) ** 2

    return Body((side, lambda p: height(p) - back - cone.height - swell), (lambda p: -height(p) - tip,))
