"""Rays that are hard for a torus."""

from __future__ import annotations

from functools import partial

import numpy as np

from minirt.shapes.torus import Torus
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
from tests.stability.common import COUNT, along, at, axis_of
from tests.stability.places import Place, fan, flat, frame, ring
from tests.stability.regime import Regime


def make(random: Random, tube: float = 0.4) -> Torus:
    """A torus of about size 1 whose tube is this share of its diameter."""
    diameter = random.uniform(0.5, 2)
    return Torus(
        tuple(random.normal(size=3)), tuple(random_directions(random).clip(-1, 1)), diameter, tube * diameter, GREY
    )


def in_the_middle(random: Random, torus: Torus) -> Array:
    """Random points of the circle in the middle of the tube."""
    return np.array(torus.centre) + torus.diameter / 2 * random_perpendiculars(random, axis_of(torus), RAYS)


def inside(random: Random, torus: Torus) -> Array:
    """Random points in the tube."""
    return in_the_middle(random, torus) + torus.tube / 2 * random.random((RAYS, 1)) * random_directions(random, RAYS)


def top(random: Random, torus: Torus) -> Array:
    """Random points of the circle along which a plane touches it."""
    return in_the_middle(random, torus) + torus.tube / 2 * axis_of(torus)


def inner(random: Random, torus: Torus) -> Array:
    """Random points of the inner equator, where it is curved like a saddle."""
    middle = np.array(torus.centre)
    return middle + (1 - torus.tube / torus.diameter) * (in_the_middle(random, torus) - middle)


def centre(_random: Random, torus: Torus) -> Array:
    return np.tile(torus.centre, (RAYS, 1))


def axis(random: Random, torus: Torus) -> Array:
    return axis_of(torus) * random.choice([-1.0, 1.0], (RAYS, 1))


def level(random: Random, torus: Torus) -> Array:
    return random_perpendiculars(random, axis_of(torus), RAYS)


def from_inside(seed: int, tube: float = 0.4) -> Rays:
    """Rays from within the tube, in all directions."""
    random = np.random.default_rng(seed)
    shapes = [make(random, tube) for _ in range(COUNT)]
    return Rays(shapes, np.stack([inside(random, shape) for shape in shapes]), random_directions(random, COUNT, RAYS))


def over_the_top(seed: int) -> Rays:
    """Rays in the plane that touches it, or 1e-14 to 1e-4 off: up to four hits are close together."""
    random = np.random.default_rng(seed)
    shapes, origins, directions = [], *np.empty((2, COUNT, RAYS, 3))
    for i in range(COUNT):
        torus = make(random)
        start, end = top(random, torus), top(random, torus)
        directions[i] = unit(end - start)
        off = log_uniform(random, 1e-14, 1e-4, RAYS, 1) * random.choice([-1.0, 0.0, 1.0], (RAYS, 1)) * axis_of(torus)
        origins[i] = start + off - random.uniform(0, 9, (RAYS, 1)) * directions[i]
        shapes.append(torus)
    return Rays(shapes, origins, directions)


def touching_twice(seed: int, off: tuple[float, float]) -> Rays:
    """Rays through the centre in a plane that touches it on both sides and cuts it in two circles (Villarceau)."""
    random = np.random.default_rng(seed)
    shapes, origins, directions = [], *np.empty((2, COUNT, RAYS, 3))
    for i in range(COUNT):
        torus = make(random)
        out, sine = random_perpendiculars(random, axis_of(torus), RAYS), torus.tube / torus.diameter
        directions[i] = np.sqrt(1 - sine**2) * out + sine * axis_of(torus)
        aside = log_uniform(random, *off, RAYS, 1) * random_directions(random, RAYS)
        origins[i] = np.array(torus.centre) + aside - random.uniform(0, 9, (RAYS, 1)) * directions[i]
        shapes.append(torus)
    return Rays(shapes, origins, directions)


# Where the tube is touched a hit is the square root of a rounding away from where the ray is nearest to it.
REGIMES = [
    Regime("at the tube", partial(at, 11, make, inside)),
    Regime("from inside", partial(from_inside, 12)),
    Regime("from inside a thin tube", partial(from_inside, 13, 1e-6)),
    Regime("at a tube of 1e-3 of the diameter", partial(at, 14, partial(make, tube=1e-3), inside)),
    Regime("at a tube of 1e-9 of the diameter", partial(at, 15, partial(make, tube=1e-9), inside)),
    Regime("at the centre of one without a hole", partial(at, 16, partial(make, tube=1.0), centre)),
    Regime("along the axis", partial(along, 17, make, axis)),
    Regime("nearly along the axis", partial(along, 18, make, axis, (1e-12, 1e-3))),
    Regime("across the axis", partial(along, 19, make, level)),
    Regime("at the top", partial(at, 20, make, top)),
    Regime("over the top", partial(over_the_top, 21)),
    Regime("at the inner equator", partial(at, 22, make, inner)),
    Regime("touching it twice", partial(touching_twice, 23, (1e-14, 1e-4))),
]


def places(torus: Torus) -> list[Place]:
    """Top and bottom with the planes that touch it there, both equators and the planes that touch the outer one, the
    circle in the middle of the tube, and the directions that touch it twice (Villarceau)."""
    u, v, axis = frame(torus.axis)
    middle, radius, tube = np.array(torus.centre), torus.diameter / 2, torus.tube / 2
    found = [ring("ring", middle, axis, radius), ring("outer equator", middle, axis, radius + tube)]
    if radius > tube:
        found += [ring("inner equator", middle, axis, radius - tube)]
        found += [fan("touching twice", torus, middle, axis, np.sqrt(radius**2 - tube**2) / tube)]
    for up in (-tube, tube):
        pole = middle + up * axis
        found += [ring("top", pole, axis, radius), flat("plane of the top", torus, pole, axis)]
    for out in (u, -v, 0.6 * u + 0.8 * v):
        found += [flat("tangent plane", torus, middle + (radius + tube) * out, out)]
        found += [flat("inner tangent plane", torus, middle + (radius - tube) * out, out)]
    return found
