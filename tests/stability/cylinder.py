"""Rays that are hard for a cylinder."""

from __future__ import annotations

from functools import partial

import numpy as np

from minirt.shapes.cylinder import Cylinder
from tests.shapes import regimes as given
from tests.shapes.regimes import GREY, RAYS, Rays, random_directions
from tests.stability.common import COUNT
from tests.stability.places import Place, flat, frame, line, ring
from tests.stability.regime import Regime


def nearly_flat(seed: int, height: float) -> Rays:
    """Rays at cylinders that are nearly flat, from above and below."""
    return given.disc(seed, height, COUNT)


def needle(seed: int) -> Rays:
    """Rays at needles: a height of 1e9 and a diameter of 1e-3."""
    random = np.random.default_rng(seed)
    shapes = [
        Cylinder(tuple(random_directions(random)), tuple(random_directions(random).clip(-1, 1)), 1e-3, 1e9, GREY)
        for _ in range(COUNT)
    ]
    axes = np.array([shape.axis for shape in shapes])[:, None]
    on = np.array([shape.centre for shape in shapes])[:, None] + random.uniform(-9, 9, (COUNT, RAYS, 1)) * axes
    origins = on + 5 * random_directions(random, COUNT, RAYS)
    return Rays(shapes, origins, given.unit(on + 1e-3 * random.uniform(-0.5, 0.5, (COUNT, RAYS, 3)) - origins))


def short_axis(seed: int) -> Rays:
    """Rays at cylinders whose axis is written 6e-8 too short, as one with seven digits is."""
    rays = given.aimed(given.cylinder, seed, count=COUNT)
    shortened = [shape.replace(axis=tuple((1 - 6e-8) * x for x in shape.axis)) for shape in rays.shapes]
    return rays._replace(shapes=shortened)


REGIMES = [
    Regime("exactly along the axis", partial(given.along_axis, 11, None, count=COUNT)),
    Regime("exactly along the axis, a scene at 1e8", partial(given.along_axis, 12, None, 1e8, COUNT)),
    Regime("nearly along the axis", partial(given.along_axis, 13, (1e-12, 1e-3), count=COUNT)),
    Regime("nearly along the axis, a scene at 1e8", partial(given.along_axis, 14, (1e-12, 1e-3), 1e8, COUNT)),
    Regime("at the rim", partial(given.rim, 15, 2 * COUNT)),
    Regime("along the side", partial(given.tangent_to_side, 16, COUNT)),
    # 1e-8 off the axis, an axis that is exact to 2^-53 leaves 1e-8 of the angle, and so of t.
    Regime("inside a tube of height 1e9", partial(given.inside_tube, 17, 1e9, COUNT), 3e-8),
    Regime("across a tube from its wall", partial(given.from_the_wall, 18, COUNT)),
    Regime("an axis off unit length by 6e-8", partial(short_axis, 21)),
    Regime("a height of 1e-9", partial(nearly_flat, 19, 1e-9)),
    Regime("a needle", partial(needle, 20)),
]


def places(cylinder: Cylinder) -> list[Place]:
    """Planes of the caps, rims, generators and the planes that touch the side."""
    u, v, axis = frame(cylinder.axis)
    centre, radius = np.array(cylinder.centre), cylinder.diameter / 2
    found = []
    for end in (-cylinder.height / 2, cylinder.height / 2):
        cap = centre + end * axis
        found += [flat("cap plane", cylinder, cap, axis), ring("rim", cap, axis, radius)]
    for out in (u, -v, 0.6 * u + 0.8 * v):
        on = centre + radius * out
        found += [line("generator", cylinder, on, axis), flat("tangent plane", cylinder, on, out)]
    return found
