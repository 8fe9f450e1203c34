"""Rays that are hard for a paraboloid."""

from __future__ import annotations

from functools import partial

import numpy as np

from minirt.shapes.paraboloid import Paraboloid
from tests.shapes.regimes import GREY, RAYS, Array, Random, random_directions
from tests.stability.common import along, at, axis_of, edge
from tests.stability.places import Place, flat, frame, ring, spot
from tests.stability.regime import Regime


def make(random: Random, height: float = 1.0) -> Paraboloid:
    """A paraboloid of about size 1, its height multiplied by a factor."""
    point, axis = tuple(random.normal(size=3)), tuple(random_directions(random).clip(-1, 1))
    return Paraboloid(point, axis, random.uniform(0.5, 2), height * random.uniform(0.5, 2), GREY)


def vertex(_random: Random, paraboloid: Paraboloid) -> Array:
    return np.tile(paraboloid.vertex, (RAYS, 1))


def rim(random: Random, paraboloid: Paraboloid) -> Array:
    middle = np.array(paraboloid.vertex) + paraboloid.height * axis_of(paraboloid)
    return edge(middle, paraboloid, paraboloid.diameter / 2, random)


def axis(random: Random, paraboloid: Paraboloid) -> Array:
    return axis_of(paraboloid) * random.choice([-1.0, 1.0], (RAYS, 1))


REGIMES = [
    Regime("along the axis", partial(along, 11, make, axis)),
    Regime("along the axis, a scene at 1e8", partial(along, 12, make, axis, None, 1e8)),
    Regime("nearly along the axis", partial(along, 13, make, axis, (1e-12, 1e-3))),
    Regime("at the rim", partial(at, 14, make, rim)),
    Regime("at the vertex", partial(at, 15, make, vertex)),
    Regime("a height of 1e-6", partial(at, 16, partial(make, height=1e-6), rim, (1e-3, 0.3))),
    Regime("a height of 1e6", partial(at, 17, partial(make, height=1e6), vertex)),
]


def places(paraboloid: Paraboloid) -> list[Place]:
    """Plane of the cap, rim, focus, and the circle around it at which the side is at 45 degrees."""
    _, _, axis = frame(paraboloid.axis)
    vertex, radius = np.array(paraboloid.vertex), paraboloid.diameter / 2
    cap, focal = vertex + paraboloid.height * axis, radius * (radius / paraboloid.height) / 4
    return [
        flat("cap plane", paraboloid, cap, axis),
        spot("centre of the cap", cap),
        ring("rim", cap, axis, radius),
        spot("focus", vertex + focal * axis),
        ring("circle around the focus", vertex + focal * axis, axis, 2 * focal),
    ]
