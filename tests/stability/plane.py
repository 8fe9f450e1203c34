"""Rays that are hard for a plane."""

from __future__ import annotations

from functools import partial

import numpy as np

from minirt.shapes.plane import Plane
from tests.shapes.regimes import GREY, RAYS, Rays, log_uniform, random_directions, random_perpendiculars
from tests.stability.common import COUNT
from tests.stability.places import Place
from tests.stability.regime import Regime


def grazing(seed: int, slope: tuple[float, float], offset: float = 0.0) -> Rays:
    """Rays at slopes in `slope`, from 1 to 20 above planes; half of the rays lead away."""
    random = np.random.default_rng(seed)
    shapes, origins, directions = [], *np.empty((2, COUNT, RAYS, 3))
    for i in range(COUNT):
        shape = Plane(tuple(offset * random_directions(random)), tuple(random_directions(random).clip(-1, 1)), GREY)
        normal = np.array(shape.normal)
        rise = log_uniform(random, *slope, RAYS, 1) * random.choice([-1.0, 1.0], (RAYS, 1))
        directions[i] = random_perpendiculars(random, normal, RAYS) * np.sqrt(1 - rise**2) + rise * normal
        origins[i] = np.array(shape.point) + random.uniform(1, 20, (RAYS, 1)) * normal
        shapes.append(shape)
    return Rays(shapes, origins, directions)


REGIMES = [
    Regime("at a slope of 0.01 to 1", partial(grazing, 11, (0.01, 1.0))),
    Regime("at a slope of 0.01 to 1, a scene at 1e8", partial(grazing, 12, (0.01, 1.0), 1e8)),
    Regime("at a slope of 1e-6 to 0.01", partial(grazing, 13, (1e-6, 1e-2))),
    Regime("at a slope of 1e-12 to 1e-6", partial(grazing, 14, (1e-12, 1e-6))),
]


def places(_plane: Plane) -> list[Place]:
    """None besides those of its fields."""
    return []
