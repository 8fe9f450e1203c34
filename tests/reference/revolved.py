"""Solids of revolution: their squared radius is a polynomial of the height."""

from __future__ import annotations

from functools import singledispatch
from typing import NamedTuple

import numpy as np

from minirt.shapes.cone import Cone
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.hyperboloid import Hyperboloid
from minirt.shapes.paraboloid import Paraboloid
from tests.reference.vectors import Array


class Profile(NamedTuple):
    """The profile radius^2 = zero + one h + two h^2, from the height `low` to `high` above the origin along the
    axis."""

    origin: Array
    axis: Array
    low: float
    high: float
    zero: float
    one: float
    two: float

    def at(self, height: Array | float) -> Array:
        """The squared radius at a height."""
        return np.asarray(self.zero + self.one * height + self.two * height * height)


@singledispatch
def profile(shape: Cone | Cylinder | Paraboloid | Hyperboloid) -> Profile:
    """The profile of a solid of revolution."""
    raise TypeError(shape)


@profile.register
def _(cone: Cone) -> Profile:
    slope = cone.diameter / 2 / cone.height
    return Profile(np.array(cone.apex), np.array(cone.axis), 0.0, cone.height, 0.0, 0.0, slope**2)


@profile.register
def _(cylinder: Cylinder) -> Profile:
    half = cylinder.height / 2
    return Profile(np.array(cylinder.centre), np.array(cylinder.axis), -half, half, cylinder.diameter**2 / 4, 0.0, 0.0)


@profile.register
def _(paraboloid: Paraboloid) -> Profile:
    per_height = paraboloid.diameter**2 / 4 / paraboloid.height
    return Profile(np.array(paraboloid.vertex), np.array(paraboloid.axis), 0.0, paraboloid.height, 0.0, per_height, 0.0)


@profile.register
def _(hyperboloid: Hyperboloid) -> Profile:
    half, waist = hyperboloid.height / 2, hyperboloid.waist / 2
    two = (hyperboloid.diameter**2 / 4 - waist**2) / half**2
    return Profile(np.array(hyperboloid.centre), np.array(hyperboloid.axis), -half, half, waist**2, 0.0, two)
