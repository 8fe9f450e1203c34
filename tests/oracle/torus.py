"""Torus: (|p|^2 + ring^2 - tube^2)^2 <= 4 ring^2 |p x axis|^2 for points p from the centre."""

from typing import Any

from gmpy2 import mpfr

from minirt.shapes.torus import Torus
from tests.oracle.body import Body, body
from tests.oracle.vectors import Vector, cross, dot, exact, minus, unit


@body.register
def _(torus: Torus, swell: Any = 0) -> Body:
    centre, axis = exact(torus.centre), unit(torus.axis)
    ring, tube = mpfr(torus.diameter) / 2, mpfr(torus.tube) / 2 + swell

    def wall(p: Vector) -> Any:
        out = minus(p, centre)
        across = cross(out, axis)
        return (dot(out, out) + ring**2 - tube**2) ** 2 - 4 * ring**2 * dot(across, across)

    return Body((wall,))
