"""Rays that are hard for a triangle."""

from __future__ import annotations

from functools import partial

import numpy as np

from minirt.shapes.triangle import Triangle
from tests.shapes.regimes import (
    GREY,
    RAYS,
    Array,
    Random,
    Rays,
    log_uniform,
    random_directions,
    random_perpendiculars,
    unit,
)
from tests.stability.common import COUNT, at
from tests.stability.places import Place, flat, line, spot
from tests.stability.regime import Regime


def make(random: Random, height: float = 1.0) -> Triangle:
    """A triangle of about size 1, its last corner at this distance from the opposite edge."""
    a, along = random.normal(size=3), random_directions(random)
    c = a + random.uniform(0, 1) * along + height * random_perpendiculars(random, along)
    return Triangle(tuple(a), tuple(a + along), tuple(c), GREY)


def corners(triangle: Triangle) -> Array:
    return np.array([triangle.a, triangle.b, triangle.c])


def inside(random: Random, triangle: Triangle) -> Array:
    return random.dirichlet(np.ones(3), RAYS) @ corners(triangle)


def edge(random: Random, triangle: Triangle) -> Array:
    share, start = random.random((RAYS, 1)), random.integers(3, size=RAYS)
    return corners(triangle)[start] * share + corners(triangle)[(start + 1) % 3] * (1 - share)


def corner(random: Random, triangle: Triangle) -> Array:
    return corners(triangle)[random.integers(3, size=RAYS)]


def grazing(seed: int, slope: tuple[float, float], height: float = 1.0) -> Rays:
    """Rays at slopes in `slope` to a triangle of a height, from both sides."""
    random = np.random.default_rng(seed)
    shapes, origins, directions = [], *np.empty((2, COUNT, RAYS, 3))
    for i in range(COUNT):
        triangle = make(random, height)
        rise = log_uniform(random, *slope, RAYS, 1) * random.choice([-1.0, 1.0], (RAYS, 1))
        normal = np.array(triangle.normal())
        directions[i] = unit(random_perpendiculars(random, normal, RAYS) + rise * normal)
        origins[i] = inside(random, triangle) - random.uniform(1, 9, (RAYS, 1)) * directions[i]
        shapes.append(triangle)
    return Rays(shapes, origins, directions)


REGIMES = [
    Regime("at an edge", partial(at, 11, make, edge)),
    Regime("at a corner", partial(at, 12, make, corner, count=3 * COUNT)),
    Regime("a sliver", partial(at, 13, partial(make, height=1e-6), inside)),
    Regime("a sliver next to none", partial(at, 14, partial(make, height=1e-12), inside)),
    Regime("at a slope of 1e-6 to 0.01", partial(grazing, 15, (1e-6, 1e-2))),
    Regime("a sliver at a slope of 1e-6 to 0.01", partial(grazing, 16, (1e-6, 1e-2), 1e-6)),
    Regime("a sliver of 1e-10 at a slope of 0.001 to 0.01", partial(grazing, 17, (1e-3, 1e-2), 1e-10)),
]


def places(triangle: Triangle) -> list[Place]:
    """Its plane, the lines of its edges, and its middle."""
    (a, *_), edges = corners(triangle), np.array(triangle.edges())
    found = [flat("plane", triangle, a, triangle.normal()), spot("middle", corners(triangle).mean(axis=0))]
    return found + [line("edge", triangle, *each) for each in zip(corners(triangle), unit(edges), strict=True)]
