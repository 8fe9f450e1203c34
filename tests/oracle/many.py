"""The oracle for many rays at once, in numbers of 106 bits: the same bodies, for a first look at a million rays."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from minirt.element import fields_of
from minirt.fields import Point
from minirt.shapes import Shape
from tests.oracle.along import Along
from tests.oracle.body import body
from tests.oracle.double_double import Array, DoubleDouble


class Crossed(NamedTuple):
    """A shape, moved outwards by a `swell` for each ray, along n rays: o + (t - approach) d with o close to it."""

    walls: list[Along]
    clips: list[Along]
    approach: Array
    solid: bool

    def nearest(self) -> Array:
        """The least t > 0 at which each ray meets the surface, infinity where none does."""
        least = np.full(self.approach.shape, np.inf)
        for wall in self.walls:
            others = [*self.clips, *(other for other in self.walls if other is not wall and self.solid)]
            for root in wall.roots():
                on = np.ones(least.shape, bool)
                for other in others:
                    on &= other(root).high <= other.noise(root.high)
                t = (root + self.approach).high
                least = np.where(on & (t > 0) & (t < least), t, least)
        return least

    def height(self, t: Array) -> Array:
        """The heights above a sheet's plane of the points at t."""
        return np.asarray(self.walls[0](DoubleDouble(t) - self.approach).high)

    def within(self, t: Array) -> Array:
        """Whether the points at t are within a sheet's edges."""
        at = DoubleDouble(t) - self.approach
        return np.logical_and.reduce([np.ones(t.shape, bool), *(clip(at).high <= 0 for clip in self.clips)])

    def inside(self, t: Array) -> Array:
        """Whether the points at t are inside and not on the surface."""
        at = DoubleDouble(t) - self.approach
        within = np.full(self.approach.shape, self.solid)
        for wall in self.walls:
            within &= wall(at).high < 0
        for clip in self.clips:
            within &= clip(at).high <= 0
        return within


def crossed(shape: Shape, origins: Array, directions: Array, swell: Any = 0) -> Crossed:
    """A shape along rays (n, 3)."""
    point = next(getattr(shape, each.name) for each in fields_of(type(shape)) if isinstance(each, Point))
    approach = np.sum((np.array(point) - origins) * directions, axis=-1)
    start = [DoubleDouble(o) + DoubleDouble(d) * approach for o, d in zip(origins.T, directions.T, strict=True)]
    ray = [Along(o, d) for o, d in zip(start, directions.T, strict=True)]
    each = body(shape, DoubleDouble(swell) if isinstance(swell, np.ndarray) else swell)
    walls, clips = ([as_along(f(ray)) for f in functions] for functions in (each.walls, each.clips))
    return Crossed(walls, clips, approach, each.solid)


def as_along(value: Any) -> Along:
    return value if isinstance(value, Along) else Along(value)
