"""Shapes in poses in which their special places have exact coordinates, and in general ones."""

from __future__ import annotations

from contextlib import suppress
from itertools import permutations, product

import numpy as np

from minirt.element import fields_of
from minirt.errors import ElementError
from minirt.fields import FARTHEST, Direction, Field, Length, Lengths, Point
from minirt.shapes import Kind, Shape
from minirt.shapes.torus import Torus
from tests.shapes.examples import random_value
from tests.shapes.regimes import Array, Random

ALIGNED = [tuple(sign * axis) for axis in np.eye(3) for sign in (1.0, -1.0)]
TURNED = sorted(  # by 3-4-5 triangles
    {turned for i, j in product((3.0, -3.0), (4.0, -4.0)) for turned in permutations((i / 5, j / 5, 0.0))}
)
LENGTHS = (0.5, 1.0, 1.25, 2.0, 2.5, 3.0, 4.0, 5.0)
SCALES = (1.0, 1.0, 1.0, 1.0, 2.0**-40, 2.0**40, 1e-9, 1e9)
OFFSETS = (0.0, 0.0, 1.0, 1.0, 2.0**10, 2.0**20)  # in scales


def pose(kind: Kind, random: Random) -> Shape:
    """A shape of round lengths at a round place: upright, turned by a 3-4-5 triangle, far away, tiny or huge; one of
    eight is a general one."""
    scale, offset = random.choice(SCALES), random.choice(OFFSETS)
    middle = scale * (offset if scale * offset < FARTHEST / 100 else 1.0) * random.integers(-8, 9, 3)
    general = random.random() < 1 / 8
    placed = [each for each in fields_of(kind.element) if not each.keyed]
    value_of = random_value if general else round_value
    while True:
        with suppress(ElementError):  # fields that contradict each other
            shape = kind.element(**{each.name: value_of(each, random, scale, middle) for each in placed})
            if not (isinstance(shape, Torus) and shape.tube == shape.diameter):  # a thicker one has a cavity
                return shape


def round_value(field: Field, random: Random, scale: float, middle: Array) -> object:
    """A value of a field with few digits."""
    if isinstance(field, Point):
        return tuple(middle + scale * random.integers(-3, 4, 3))
    if isinstance(field, Direction):
        ways = ALIGNED if random.random() < 0.5 else TURNED
        return ways[random.integers(len(ways))]
    if isinstance(field, Length):
        return scale * random.choice(LENGTHS)
    if isinstance(field, Lengths):
        return tuple(scale * random.choice(LENGTHS, 3))
    return random_value(field, random, scale, middle)
