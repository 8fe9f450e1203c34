"""Sphere: |p - centre|^2 <= radius^2."""

from typing import Any

from gmpy2 import mpfr

from minirt.shapes.sphere import Sphere
from tests.oracle.body import Body, body
from tests.oracle.vectors import Vector, dot, exact, minus


@body.register
def _(sphere: Sphere, swell: Any = 0) -> Body:
    centre, radius = exact(sphere.centre), mpfr(sphere.diameter) / 2 + swell

    def ball(p: Vector) -> Any:
        out = minus(p, centre)
        return dot(out, out) - radius**2

    return Body((ball,))
