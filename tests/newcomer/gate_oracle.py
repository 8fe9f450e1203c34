"""z = 0 within half a side of the centre: a sheet."""

from typing import Any

from gmpy2 import mpfr
from minirt.shapes.gate import Gate  # type: ignore[import-not-found]

from tests.oracle.body import Body, body, exact


@body.register
def _(gate: Gate, swell: Any = 0) -> Body:
    (x, y, z), half = exact(gate.centre), mpfr(gate.side) / 2 + swell
    edges = (lambda p: (p[0] - x) ** 2 - half * abs(half), lambda p: (p[1] - y) ** 2 - half * abs(half))
    return Body((lambda p: p[2] - z,), edges, solid=False)
