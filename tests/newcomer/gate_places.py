"""Rays that are hard for a gate."""

from __future__ import annotations

import numpy as np
from minirt.shapes.gate import Gate  # type: ignore[import-not-found]

from tests.stability.places import Place, line, special, spot


@special.register
def _(gate: Gate) -> list[Place]:
    """Its corners and edges."""
    found = []
    for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
        corner = np.array(gate.centre) + gate.side / 2 * np.array([x, y, 0.0])
        found += [spot("corner", corner), line("edge", gate, corner, (-y, x, 0.0))]
    return found
