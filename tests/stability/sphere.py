"""Where a sphere is hard."""

from __future__ import annotations

from functools import partial

import numpy as np

from minirt.shapes.sphere import Sphere
from tests.shapes.regimes import GREY, RAYS, Rays, just_above, ways
from tests.stability.common import COUNT
from tests.stability.regime import Regime


def just_inside(seed: int) -> Rays:
    """From a millionth of the radius, or less, under the surface of a sphere of diameter 1e9."""
    random = np.random.default_rng(seed)
    out = ways(random, COUNT, RAYS)
    shapes = [Sphere((0, 0, 0), 1e9, GREY)] * COUNT
    return Rays(shapes, (5e8 - random.uniform(1e-6, 500, (COUNT, RAYS, 1))) * out, ways(random, COUNT, RAYS))


def in_the_centre(seed: int) -> Rays:
    """From the centre of spheres of all sizes."""
    random = np.random.default_rng(seed)
    shapes = [Sphere(tuple(ways(random)), 10.0**exponent, GREY) for exponent in np.linspace(-15, 15, COUNT)]
    origins = np.stack([shape.centre for shape in shapes])[:, None] * np.ones((COUNT, RAYS, 1))
    return Rays(shapes, origins, ways(random, COUNT, RAYS))


REGIMES = [
    *(
        Regime(f"from {height} above a diameter of 1e9", partial(just_above, 11, height, COUNT), 1e-9, 0.0)
        for height in (1e-6, 1e-3, 1.7)
    ),
    Regime("from inside a diameter of 1e9", partial(just_inside, 12), 1e-9, 0.0),
    Regime("from the centre", partial(in_the_centre, 13), 4e-16, 0.0),
]
