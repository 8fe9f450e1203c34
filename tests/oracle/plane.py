"""Plane: (p - point) . normal = 0; a sheet without an edge."""

from typing import Any

from minirt.shapes.plane import Plane
from tests.oracle.body import Body, body
from tests.oracle.vectors import dot, exact, minus, unit


@body.register
def _(plane: Plane, _swell: Any = 0) -> Body:
    point, normal = exact(plane.point), unit(plane.normal)
    return Body((lambda p: dot(minus(p, point), normal),), solid=False)
