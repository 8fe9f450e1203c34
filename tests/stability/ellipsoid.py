"""Rays that are hard for an ellipsoid."""

from __future__ import annotations

from functools import partial

import numpy as np

from minirt.shapes.ellipsoid import Ellipsoid
from tests.shapes.regimes import GREY, RAYS, Array, Random, random_directions
from tests.stability.common import along, at
from tests.stability.places import Place, flat, spot
from tests.stability.regime import Regime


def make(random: Random, flatness: float = 1.0) -> Ellipsoid:
    """A random ellipsoid of about size 1, its own y axis scaled by `flatness`."""
    sizes = random.uniform(0.5, 2, 3) * [1.0, flatness, 1.0]
    return Ellipsoid(tuple(random.normal(size=3)), tuple(random_directions(random).clip(-1, 1)), tuple(sizes), GREY)


def own_axes(ellipsoid: Ellipsoid) -> tuple[Array, Array]:
    """The semi-axes in ascending order, (3,), and their directions, (3, 3)."""
    lengths, directions = zip(*ellipsoid.axes(), strict=True)
    return np.array(lengths), np.array(directions)


def tips(random: Random, ellipsoid: Ellipsoid) -> Array:
    """Ends of its axes, where it is curved most and least."""
    lengths, directions = own_axes(ellipsoid)
    chosen = random.integers(3, size=RAYS)
    signs = random.choice([-1.0, 1.0], RAYS)
    return np.array(ellipsoid.centre) + (signs * lengths[chosen])[:, None] * directions[chosen]


def directions(random: Random, ellipsoid: Ellipsoid) -> Array:
    """Directions of its axes, there and back."""
    return own_axes(ellipsoid)[1][random.integers(3, size=RAYS)] * random.choice([-1.0, 1.0], (RAYS, 1))


# At a tip of a flat or a long one a rounding across the short axis moves the hit far along the long one.
REGIMES = [
    Regime("at the ends of its axes", partial(at, 11, make, tips)),
    Regime("along an axis", partial(along, 12, make, directions)),
    Regime("nearly along an axis", partial(along, 13, make, directions, (1e-14, 1e-3))),
    Regime("along an axis, a scene at 1e8", partial(along, 14, make, directions, None, 1e8)),
    Regime("at the ends of a flat one", partial(at, 15, partial(make, flatness=1e-6), tips), blur=np.inf),
    Regime("at the ends of a long one", partial(at, 16, partial(make, flatness=1e6), tips), blur=np.inf),
]


def places(ellipsoid: Ellipsoid) -> list[Place]:
    """The ends of its axes, with the planes that touch them."""
    found = []
    for length, axis in zip(*own_axes(ellipsoid), strict=True):
        for sign in (-1, 1):
            tip = np.array(ellipsoid.centre) + sign * length * axis
            found += [spot("tip", tip), flat("tangent plane", ellipsoid, tip, axis)]
    return found
