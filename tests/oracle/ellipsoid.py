"""Ellipsoid: (p . x / a)^2 + (p . y / b)^2 + (p . z / c)^2 <= 1 for points p from the centre, and its own axes."""

from typing import Any

from gmpy2 import mpfr

from minirt.shapes.ellipsoid import Ellipsoid
from tests.oracle.body import Body, body
from tests.oracle.vectors import Vector, dot, exact, minus, own_axes


@body.register
def _(ellipsoid: Ellipsoid, swell: Any = 0) -> Body:
    centre = exact(ellipsoid.centre)
    semi_axes = [mpfr(size) / 2 + swell for size in ellipsoid.sizes]
    axes = list(zip(own_axes(ellipsoid.axis, ellipsoid.roll), semi_axes, strict=True))

    def wall(p: Vector) -> Any:
        out = minus(p, centre)
        x, y, z = ((dot(out, axis) * (1 / semi)) ** 2 for axis, semi in axes)
        return x + y + z - 1

    return Body((wall,))
