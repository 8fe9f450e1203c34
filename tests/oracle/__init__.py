"""The oracle: where rays cross the surface of a shape, by its `boundary` computed with many digits.

The numbers of scene, ray and shape are taken as they are, to the last bit; only axes and normals are scaled to exact
unit length, as a scene intends. Along a ray each face of a boundary is a function of t, built of polynomials, their
square roots and absolute values. Multiplied by its conjugates it becomes a polynomial (`tests.oracle.numbers`), whose
roots cut the ray into pieces. On each of these no face changes its sign: a piece is inside the shape or outside, as its
middle is. No formula is solved for t by hand.

So a new shape needs nothing here. `tests/shapes/test_known_answers.py` holds the oracle to answers by hand, and
`tests/stability/test_certificates.py` compares boundaries with closed forms that share nothing with them.
"""

from __future__ import annotations

from functools import cached_property
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
from gmpy2 import const_pi, cos, mpfr, sin

from minirt.element import fields_of
from minirt.fields import Angle, Direction, Length, Lengths, Point
from minirt.lanes import Vec
from minirt.rendering.queries.nearest_point import seeded
from minirt.shapes import KINDS, Kind, Shape
from minirt.shapes.boundary import Boundary, DoubleDouble, unit
from tests.oracle.numbers import Along, Array, Number, in_digits

FARTHEST = 1e100  # t beyond which no shape is: squares of greater numbers overflow
SHARES = np.array([0.5, 0.2, 0.8])[:, None, None]  # of a piece: places at which it is looked at


def kind_of(shape: Shape) -> Kind:
    return next(kind for kind in KINDS if kind.element is type(shape))


def is_sheet(shape: Shape) -> bool:
    """Whether a shape has no inside; a plane, too, is seen from both sides."""
    return not shape.solid or shape.infinite


def number(x: Any, digits: bool) -> Number:
    """A float64 or mpfr number, or an array, as the oracle computes with it."""
    if digits:
        return Number(in_digits(x))
    high = np.asarray(x, np.float64)
    return Number(DoubleDouble(high, np.asarray(x - mpfr(float(high)), np.float64) if isinstance(x, mpfr) else 0.0))


def exact_shape(shape: Shape, digits: bool = False) -> SimpleNamespace:
    """The fields of a shape as `boundary` takes them."""
    found: dict[str, Any] = {}
    for field in fields_of(type(shape)):
        value = getattr(shape, field.name)
        if isinstance(field, Angle):
            angle = mpfr(value) * const_pi() / 180
            found[field.name] = number(cos(angle), digits), number(sin(angle), digits)
        elif isinstance(field, Length):
            found[field.name] = number(value, digits)
        elif isinstance(field, Point | Lengths | Direction):
            parts = Vec(*(number(float(part), digits) for part in value))
            found[field.name] = unit(parts) if isinstance(field, Direction) else parts
    return SimpleNamespace(**found)


def points(shape: Shape) -> list[Array]:
    """The points that a shape is given by."""
    return [np.array(getattr(shape, each.name), float) for each in fields_of(type(shape)) if isinstance(each, Point)]


def size(shape: Shape) -> float:
    """The sum of the lengths that a shape is given by and of the distances between its points."""
    lengths = [np.sum(getattr(shape, e.name)) for e in fields_of(type(shape)) if isinstance(e, (Length, Lengths))]
    first, *others = points(shape)
    return float(sum(lengths) + sum(np.linalg.norm(other - first) for other in others))


class Heights(NamedTuple):
    """Heights of points (...) above the faces and limits of a shape, to first order, and the slopes there."""

    faces: Array  # (k, ...)
    limits: Array  # (l, ...)
    normals: Array  # (k + l, 3, ...) outward

    @property
    def above(self) -> Array:
        """Height above the surface of a solid, negative inside."""
        return np.asarray(np.fmax.reduce([*self.faces, *self.limits]))

    @property
    def beyond(self) -> Array:
        """Distance beyond the edges of a sheet, negative within them."""
        return np.asarray(np.fmax.reduce([np.full(self.faces.shape[1:], -np.inf), *self.limits]))


def heights(shape: Shape, place: Vec, exact: Boundary | None = None) -> Heights:
    """Heights of a place above the faces of a shape; of their values by `exact`, if that is given."""
    like = place.x.high
    with np.errstate(all="ignore"):
        seeds = Vec(*map(Number, components(seeded(place))))
        both = kind_of(shape).boundary(exact_shape(shape), seeds)
        values, normals = [], []
        for each, value in zip((*both.faces, *both.limits), sum(exact or both, ()), strict=True):
            slope = np.array([part + 0.0 * like for part in components(each.slope)])
            steep = np.linalg.norm(slope, axis=0)
            values.append((value.high + 0.0 * like) / steep)
            normals.append(slope / steep)
    count = len(both.faces)
    limits = np.reshape(values[count:], (len(values) - count, *like.shape))
    return Heights(np.array(values[:count]), limits, np.array(normals))


class Crossed:
    """A shape and n rays, (n, 3) each: where they cross its surface."""

    def __init__(self, shape: Shape, origins: Array, directions: Array, digits: bool = False) -> None:
        self.shape, self.origins, self.directions, self.digits = shape, origins, directions, digits
        with np.errstate(all="ignore"):
            # t is counted from where the ray is nearest to the first point of the shape: there its numbers are small.
            self.approach = np.sum((points(shape)[0] - origins) * directions, axis=-1)

    @cached_property
    def zeros(self) -> tuple[Array, Array]:
        """The t at which the rays cross the faces, (k, n), and the limits, (l, n), NaN where they do not."""
        with np.errstate(all="ignore"):
            way = [number(each, self.digits) for each in self.directions.T]
            start = [number(o, self.digits) + d * self.approach for o, d in zip(self.origins.T, way, strict=True)]
            ray = Vec(*(line(*each) for each in zip(start, way, strict=True)))
            faces, limits = (
                np.reshape([(t + self.approach).high for each in some for t in each.zeros()], (-1, len(self.origins)))
                for some in kind_of(self.shape).boundary(exact_shape(self.shape, self.digits), ray)
            )
            return faces, limits

    def heights(self, t: Array) -> Heights:
        """Heights of the points of the rays at t, (..., n)."""

        def place(digits: bool) -> Vec:
            o, d = ([number(part, digits) for part in each.T] for each in (self.origins, self.directions))
            return Vec(*(x + y * t for x, y in zip(o, d, strict=True)))

        there = Vec(*(each.value for each in components(place(False))))
        if not self.digits:
            return heights(self.shape, there)
        return heights(self.shape, there, kind_of(self.shape).boundary(exact_shape(self.shape, True), place(True)))

    def pieces(self, start: Array | None = None, shares: Array = SHARES) -> tuple[Array, Array, Array]:
        """Cut the rays, from `start` on, where a face or a limit may change its sign.

        Returns the ends of the pieces, (k + 1, n), the greatest height above the surface that was seen in each,
        negative inside, (k, n), and where. Pieces of no length have the height 0.
        """
        cuts = np.concatenate(self.zeros)
        cuts[np.abs(cuts) > FARTHEST] = np.nan
        far = 4 * (np.fmax.reduce([*np.abs(cuts - self.approach), 0 * self.approach]) + size(self.shape))
        begin = self.approach - far if start is None else start
        end = np.maximum(self.approach, begin) + far
        cuts = np.sort(np.where((cuts > begin) & (cuts < end), cuts, end), axis=0)
        cuts = np.stack([begin, *cuts, end])
        looks = cuts[:-1] + shares * (cuts[1:] - cuts[:-1])
        above = np.nan_to_num(np.where(cuts[1:] > cuts[:-1], self.heights(looks).above, 0.0), nan=0.0)
        best = np.abs(above).argmax(axis=0)[None]
        return cuts, *(np.take_along_axis(each, best, axis=0)[0] for each in (above, looks))

    def crossings(self) -> Array:
        """All t at which the rays cross the surface, (k, n) in ascending order, then NaN."""
        if is_sheet(self.shape):
            faces, _ = self.zeros
            return np.where(self.heights(faces).beyond <= 0, faces, np.nan)
        cuts, above, _ = self.pieces(shares=SHARES[:1])
        for i in range(1, len(above)):  # a piece of no length is as the one before
            above[i] = np.where(above[i] == 0, above[i - 1], above[i])
        changed = (above[1:] < 0) != (above[:-1] < 0)
        return np.sort(np.where(changed, cuts[1:-1], np.nan), axis=0)

    def nearest(self) -> Array:
        """The least t > 0 at which each ray crosses the surface, infinity where none does."""
        t = self.crossings()
        return np.asarray(np.where(t > 0, t, np.inf).min(axis=0, initial=np.inf))


def line(start: Number, way: Number) -> Along:
    """The function start + t way."""
    return Along({frozenset(): {frozenset(): [start, way]}})


def components(v: Vec) -> tuple[Any, Any, Any]:
    return v.x, v.y, v.z


def nearest(shape: Shape, origin: Any, direction: Any) -> float:
    """The least t > 0 at which origin + t direction crosses the surface, in 60 digits; infinity where none does."""
    return float(Crossed(shape, np.array([origin], float), np.array([direction], float), True).nearest()[0])


def normals(shape: Shape, places: Array) -> Array:
    """The outward unit normals at places (n, 3) of the surface, or of the nearest face beside it."""
    found = heights(shape, Vec(*map(DoubleDouble, places.T)))
    return np.asarray(np.take_along_axis(found.normals, np.abs(found.faces).argmin(axis=0)[None, None], axis=0)[0].T)
