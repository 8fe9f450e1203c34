"""Between three pairs of planes, at right angles to the box's own axes."""

from typing import Any

from gmpy2 import mpfr

from minirt.shapes.box import Box
from tests.oracle.body import Body, Implicit, body
from tests.oracle.vectors import Vector, dot, exact, minus, unit


@body.register
def _(box: Box, swell: Any = 0) -> Body:
    centre, axis = exact(box.centre), unit(box.axis)
    sign = 1 if axis[1] >= 0 else -1
    # Half-way between y and the axis: half a turn about that takes y to the axis, x and z to the opposites of its own.
    middle = unit([axis[0], axis[1] + sign, axis[2]])

    def turned(v: Vector) -> Vector:
        return [2 * dot(v, middle) * m - x for x, m in zip(v, middle, strict=True)]

    def face(axis: Vector, half: Any) -> Implicit:
        return lambda p: dot(minus(p, centre), axis) - half - swell

    axes = [turned(exact((1, 0, 0))), axis, turned(exact((0, 0, 1)))]
    halves = [mpfr(size) / 2 for size in box.sizes]
    pairs = [(v, h) for v, h in zip(axes, halves, strict=True)]
    return Body(tuple(face([side * x for x in v], h) for v, h in pairs for side in (1, -1)))
