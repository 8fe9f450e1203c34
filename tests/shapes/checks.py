"""Helpers of tests that know the answers of `intersect`."""

from __future__ import annotations

import numpy as np

from minirt.shapes import Shape
from tests.shapes.execution_modes import Intersect
from tests.shapes.regimes import RAYS

U = 2.0**-53


def shoot(intersect: Intersect, shape: Shape, *rays: tuple[tuple[float, ...], tuple[float, ...]]) -> list[float]:
    """t of rays, each an origin and a direction."""
    padded = [*rays, *[rays[-1]] * (-len(rays) % RAYS)]
    origins, directions = (np.array([ray[part] for ray in padded], float)[None] for part in (0, 1))
    return list(intersect([shape], origins, directions)[0, : len(rays)])
