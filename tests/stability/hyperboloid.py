"""Rays that are hard for a hyperboloid."""

from __future__ import annotations

from functools import partial

import numpy as np

from minirt.shapes.hyperboloid import Hyperboloid
from tests.shapes.regimes import GREY, RAYS, Array, Random, random_directions, random_perpendiculars, unit
from tests.stability.common import along, at, axis_of, edge
from tests.stability.places import Place, fan, flat, frame, line, ring
from tests.stability.regime import Regime


def make(random: Random, waist: float = 0.5) -> Hyperboloid:
    """A hyperboloid of about size 1 whose waist is this share of its diameter."""
    diameter = random.uniform(0.5, 2)
    point, axis = tuple(random.normal(size=3)), tuple(random_directions(random).clip(-1, 1))
    return Hyperboloid(point, axis, waist * diameter, diameter, random.uniform(0.5, 2), GREY)


def slope(hyperboloid: Hyperboloid) -> float:
    """Slope of the asymptotic cone: radius by height."""
    return float(np.sqrt(hyperboloid.diameter**2 - hyperboloid.waist**2)) / hyperboloid.height


def rim(random: Random, hyperboloid: Hyperboloid) -> Array:
    middle = np.array(hyperboloid.centre) + hyperboloid.height / 2 * axis_of(hyperboloid)
    return edge(middle, hyperboloid, hyperboloid.diameter / 2, random)


def waist(random: Random, hyperboloid: Hyperboloid) -> Array:
    return edge(np.array(hyperboloid.centre), hyperboloid, hyperboloid.waist / 2, random)


def asymptote(random: Random, hyperboloid: Hyperboloid) -> Array:
    axis = axis_of(hyperboloid)
    return unit(axis + slope(hyperboloid) * random_perpendiculars(random, axis, RAYS)) * random.choice(
        [-1.0, 1.0], (RAYS, 1)
    )


def beside_rulings(seed: int, off: tuple[float, float]) -> object:
    """Rays along the rulings, the straight lines in the surface, at a distance in `off` beside them."""
    rays = along(seed, make, asymptote)
    random = np.random.default_rng(seed)
    for shape, origins, directions in zip(rays.shapes, rays.origins, rays.directions, strict=True):
        axis = axis_of(shape)
        aside = unit(np.cross(directions, axis))  # such a line leaves the waist at a right angle to its way out
        start = np.array(shape.centre) + shape.waist / 2 * aside
        apart = np.exp(random.uniform(*np.log(off), (RAYS, 1))) * random.choice([-1.0, 1.0], (RAYS, 1))
        origins[:] = start + apart * aside - 5 * directions
    return rays


REGIMES = [
    Regime("along an asymptote", partial(along, 11, make, asymptote)),
    Regime("along an asymptote, a scene at 1e8", partial(along, 12, make, asymptote, None, 1e8)),
    Regime("nearly along an asymptote", partial(along, 13, make, asymptote, (1e-12, 1e-3))),
    Regime("along a ruling", partial(beside_rulings, 14, (1e-3, 1e-1))),
    Regime("closely along a ruling", partial(beside_rulings, 15, (1e-14, 1e-6))),
    Regime("at the rim", partial(at, 16, make, rim)),
    Regime("at the waist", partial(at, 17, make, waist)),
    Regime("a waist of 1e-6 of the diameter", partial(at, 18, partial(make, waist=1e-6), waist, (1e-3, 1e-1))),
    Regime("closely at a waist of 1e-6 of that", partial(at, 20, partial(make, waist=1e-6), waist, (1e-9, 1e-6))),
    Regime("a waist as wide as the ends", partial(at, 19, partial(make, waist=1.0), waist, (1e-3, 1e-1))),
]


def places(hyperboloid: Hyperboloid) -> list[Place]:
    """Planes of the caps, rims, waist and the planes that touch it, asymptotes and rulings."""
    u, v, axis = frame(hyperboloid.axis)
    centre, steep = np.array(hyperboloid.centre), slope(hyperboloid)
    found = [
        ring("waist", centre, axis, hyperboloid.waist / 2),
        fan("asymptotes", hyperboloid, centre, axis, steep),
    ]
    for end in (-hyperboloid.height / 2, hyperboloid.height / 2):
        cap = centre + end * axis
        found += [flat("cap plane", hyperboloid, cap, axis), ring("rim", cap, axis, hyperboloid.diameter / 2)]
    for out, aside in ((u, v), (-v, u), (0.6 * u + 0.8 * v, 0.8 * u - 0.6 * v)):
        on = centre + hyperboloid.waist / 2 * out
        found += [flat("tangent plane", hyperboloid, on, out)]
        found += [line("ruling", hyperboloid, on, axis + sign * steep * aside) for sign in (-1, 1)]
    return found
