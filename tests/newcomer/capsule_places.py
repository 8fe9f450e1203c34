"""Rays that are hard for a capsule."""

from __future__ import annotations

import numpy as np
from minirt.shapes.capsule import Capsule  # type: ignore[import-not-found]

from tests.stability.places import Place, flat, special, spot


@special.register
def _(capsule: Capsule) -> list[Place]:
    """Its tips, and the planes in which its side ends."""
    axis, found = np.array(capsule.axis), []
    for way in (capsule.height / 2, -capsule.height / 2):
        end = np.array(capsule.centre) + way * axis
        tip = end + np.copysign(capsule.diameter / 2, way) * axis
        found += [spot("tip", tip), flat("plane at an end of the side", capsule, end, axis)]
    return found
