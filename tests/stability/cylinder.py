"""Rays that are hard for a cylinder."""

from __future__ import annotations

from functools import partial

import numpy as np

from minirt.shapes.cylinder import Cylinder
from tests.shapes import regimes as given
from tests.shapes.examples import place
from tests.shapes.regimes import RAYS, Array, Random, Rays
from tests.stability.common import COUNT, along, at, axis_of, edge
from tests.stability.places import Place, flat, frame, line, ring
from tests.stability.regime import Regime


def make(random: Random) -> Cylinder:
    """A cylinder of about size 1."""
    return given.cylinder(random, 1.0, 0.0)


def along_the_axis(_random: Random, cylinder: Cylinder) -> Array:
    return np.tile(cylinder.axis, (RAYS, 1))


def rim(random: Random, cylinder: Cylinder) -> Array:
    middle = np.array(cylinder.centre) + cylinder.height / 2 * axis_of(cylinder)
    return edge(middle, cylinder, cylinder.diameter / 2, random)


def short_axis(seed: int) -> Rays:
    """Rays at cylinders whose axis is written 6e-8 too short, as one with seven digits is."""
    rays = at(seed, make, lambda random, shape: place(shape) + random.uniform(-0.6, 0.6, (RAYS, 3)))
    shortened = [shape.replace(axis=tuple((1 - 6e-8) * x for x in shape.axis)) for shape in rays.shapes]
    return rays._replace(shapes=shortened)


REGIMES = [
    Regime("exactly along the axis", partial(along, 11, make, along_the_axis)),
    Regime("exactly along the axis, a scene at 1e8", partial(along, 12, make, along_the_axis, None, 1e8)),
    Regime("nearly along the axis", partial(along, 13, make, along_the_axis, (1e-12, 1e-3))),
    Regime("nearly along the axis, a scene at 1e8", partial(along, 14, make, along_the_axis, (1e-12, 1e-3), 1e8)),
    Regime("at the rim", partial(at, 15, make, rim, count=2 * COUNT)),
    # 1e-8 off the axis, an axis that is exact to 2^-53 leaves 1e-8 of the angle, and so of t.
    Regime("inside a tube of height 1e9", partial(given.inside_tube, 17, 1e9, COUNT), 3e-8),
    Regime("across a tube from its wall", partial(given.from_the_wall, 18, COUNT)),
    Regime("an axis off unit length by 6e-8", partial(short_axis, 21)),
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
