"""Rays that are hard for a sphere."""

from __future__ import annotations

from functools import partial

import numpy as np

from minirt.shapes.sphere import Sphere
from tests.shapes.regimes import (
    GREY,
    RAYS,
    Rays,
    log_uniform,
    random_directions,
    random_perpendiculars,
    unit,
)
from tests.stability.common import COUNT
from tests.stability.places import Place, flat, spot
from tests.stability.regime import Regime


def near_the_surface(seed: int) -> Rays:
    """Rays downwards from a billionth of the radius to a whole radius above the surface, and as far below it."""
    random = np.random.default_rng(seed)
    count = 4 * COUNT
    out = random_directions(random, count, RAYS)
    height = log_uniform(random, 1e-9, 1.0, count, RAYS, 1) * random.choice([-1.0, 1.0], (count, RAYS, 1))
    down = unit(random_perpendiculars(random, out, count, RAYS) - random.uniform(0.1, 10, (count, RAYS, 1)) * out)
    directions = np.where(height > 0, down, random_directions(random, count, RAYS))
    centre = random_directions(random)
    return Rays([Sphere(tuple(centre), 2.0, GREY)] * count, centre + (1 + height) * out, directions)


def to_the_horizon(seed: int, above: tuple[float, float], dips: tuple[float, ...]) -> Rays:
    """Rays from above a sphere of diameter 1e9, at given fractions of the dip of its horizon."""
    random = np.random.default_rng(seed)
    up = random_directions(random, COUNT, RAYS)
    height = log_uniform(random, *above, COUNT, RAYS, 1)
    dip = np.sqrt(2 * height / 5e8) * random.choice(dips, (COUNT, RAYS, 1))
    shapes = [Sphere((0, 0, 0), 1e9, GREY)] * COUNT
    return Rays(shapes, (5e8 + height) * up, unit(random_perpendiculars(random, up, COUNT, RAYS) - dip * up))


def in_the_centre(seed: int) -> Rays:
    """Rays from the centre of spheres of all sizes."""
    random = np.random.default_rng(seed)
    shapes = [
        Sphere(tuple(random_directions(random)), 10.0**exponent, GREY) for exponent in np.linspace(-15, 15, COUNT)
    ]
    origins = np.stack([shape.centre for shape in shapes])[:, None] * np.ones((COUNT, RAYS, 1))
    return Rays(shapes, origins, random_directions(random, COUNT, RAYS))


REGIMES = [
    Regime("from 1e-9 to 1 radius off the surface", partial(near_the_surface, 14), 3e-14, 0.0),
    # There the angle below the horizon is 1e-8 of a direction that is exact to 2^-53.
    Regime(
        "to the horizon of a diameter of 1e9",
        partial(to_the_horizon, 15, (1e-3, 2.0), (0.5, 0.99, 1.01, 1.1, 3.0)),
        1e-8,
        0.0,
    ),
    Regime(
        "at the very horizon of a diameter of 1e9",
        partial(to_the_horizon, 16, (1e-6, 1e-3), (0.9999, 1.0001)),
        1e-6,
        0.0,
    ),
    Regime("from the centre", partial(in_the_centre, 13), 4e-16, 0.0),
]


def places(sphere: Sphere) -> list[Place]:
    """Its poles along the axes of the scene, with the planes that touch them."""
    found = []
    for axis in np.concatenate([np.eye(3), -np.eye(3)]):
        pole = np.array(sphere.centre) + sphere.diameter / 2 * axis
        found += [spot("pole", pole), flat("tangent plane", sphere, pole, axis)]
    return found
