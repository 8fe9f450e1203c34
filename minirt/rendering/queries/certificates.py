"""Certificates of hits: how far a computed hit is from the exact surface, and how much the data's errors move it.

**Backward error** of a hit at distance t along a ray from o in the direction d: the distance of the point o + t d from
the surface, from its faces, edges and corners, in units of u M. Here u is 2^-53, and M = t + |o - c| + size is what t
is computed from: t itself, the way from the ray's origin to the first point c that the shape is given by, and the sum
of the shape's lengths and of the distances between its points. An algorithm is backward stable if the error is a small
constant, wherever the ray comes from. Beyond a sharp rim, where two faces meet at an angle a, the distance may be
1 / sin(a / 2) times that from each face.

**Condition number** of t: its relative change per relative change of the data. If o - c, the lengths and the distance
along d change by at most e of each, the point o + t d moves relative to the surface by at most e M, and t follows by
the implicit function theorem: from F(o + t d) = 0 comes dt = -dF / (grad F . d), a move by e M along the unit normal n
divided by n . d. So

    condition = M / (t |n . d|),    |error of t| / t <= backward error * u * condition    to first order,

which is the rule of thumb of Higham, Accuracy and Stability of Numerical Algorithms (2002), 1.6. Where a ray only
touches a surface the condition number is infinite: t then changes by the square root of a change of the data.

All this is computed with double-double numbers (`minirt.shapes.boundary`) from the numbers of the scene as they
are, with directions and axes of exactly unit length. Of a mesh the corners of the triangles count as the scene places
them, rounded. That nothing nearer was missed, a certificate does not say.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import NamedTuple, get_type_hints

import numpy as np

from minirt.element import fields_of
from minirt.fields import Angle, Direction, Length, Lengths, Point, cos_and_sin
from minirt.lanes import Vec
from minirt.rendering.queries.nearest_point import Array, Integers, foot
from minirt.shapes import ALL_KINDS, Kind, Shape
from minirt.shapes.boundary import DoubleDouble, hypotenuse, unit
from minirt.shapes.compensated import two_sum
from minirt.shapes.shape import Position

Columns = dict[str, Array]  # by the name of the field, a row for each shape, or for each part of it


class ExactFields(NamedTuple):
    """The numbers of shapes of one kind, in columns."""

    points: Columns  # (n, 3)
    lengths: Columns  # (n,) or (n, 3)
    directions: Columns  # (n, 3), of unit length but for rounding
    turns: Columns  # (n, 2) cosine and sine of an angle
    sizes: Array  # (n,) sum of the lengths and of the distances of the points from the first one
    first_row: Integers  # of each shape

    def shape(self, rows: Integers, first: Array, power: Integers) -> SimpleNamespace:
        """The shapes in some rows as one shape: its fields by name, relative to the `first` points, times 2^power.

        Directions have exactly unit length.
        """
        points = {name: exact_point(each[rows], first, power) for name, each in self.points.items()}
        lengths = {name: exact_length(each[rows], power) for name, each in self.lengths.items()}
        directions = {name: exact_direction(each[rows]) for name, each in self.directions.items()}
        turns = {name: exact_turn(each[rows]) for name, each in self.turns.items()}
        return SimpleNamespace(**points, **lengths, **directions, **turns)


def exact_fields(kind: Kind, shapes: list[Shape]) -> ExactFields:
    """Collect the numbers of shapes of one kind: of their fields or, for a batched kind, of their packed form, which
    has points and directions alone."""
    if kind.element.batched:
        points, lengths, directions = columns_of_packed(kind, shapes)
    else:
        points, lengths, directions = (
            {
                each.name: np.array([getattr(shape, each.name) for shape in shapes], np.float64)
                for each in fields_of(kind.element)
                if isinstance(each, sort) and not each.keyed
            }
            for sort in (Point, (Length, Lengths), Direction)
        )
    turns = {
        each.name: np.array([cos_and_sin(getattr(shape, each.name)) for shape in shapes])
        for each in fields_of(kind.element)
        if isinstance(each, Angle) and not kind.element.batched
    }
    first, *others = points.values()
    sums = [each.reshape(len(each), -1).sum(axis=1) for each in lengths.values()]
    sizes = sum((*sums, *(lengths_of(each - first) for each in others)), np.zeros(len(first)))
    first_row = np.cumsum([0, *(shape.parts for shape in shapes[:-1])])
    return ExactFields(points, lengths, directions, turns, sizes, first_row)


def lengths_of(vectors: Array) -> Array:
    """The lengths of vectors (n, 3), none of which under- or overflows."""
    return np.hypot(np.hypot(vectors[:, 0], vectors[:, 1]), vectors[:, 2])


def columns_of_packed(kind: Kind, shapes: list[Shape]) -> tuple[Columns, Columns, Columns]:
    """The points, lengths and directions of all parts of shapes, in their packed form, which has no lengths."""
    packed = [shape.pack() for shape in shapes]
    columns: dict[object, Columns] = {Position: {}, Vec: {}}
    for name, hint in get_type_hints(kind.packed).items():
        if hint in columns:
            vecs = [getattr(each, name) for each in packed]
            columns[hint][name] = np.concatenate([np.stack([v.x, v.y, v.z], axis=-1) for v in vecs])
    return columns[Position], {}, columns[Vec]


def exact_point(points: Array, first: Array, power: Integers) -> Vec:
    """The vectors from the `first` points to others, times 2^power."""
    parts = (two_sum(one, -other) for one, other in zip(points.T, first.T, strict=True))
    return Vec(*(DoubleDouble(np.ldexp(high, power), np.ldexp(low, power)) for high, low in parts))


def exact_length(lengths: Array, power: Integers) -> DoubleDouble | Vec:
    """One length or three, times 2^power."""
    parts = [DoubleDouble(np.ldexp(part, power)) for part in np.atleast_2d(lengths.T)]
    return parts[0] if lengths.ndim == 1 else Vec(*parts)


def exact_direction(directions: Array) -> Vec:
    """Directions of exactly unit length."""
    return unit(Vec(*map(DoubleDouble, directions.T)))


def exact_turn(turns: Array) -> tuple[DoubleDouble, DoubleDouble]:
    """Cosine and sine of angles, their squares adding up to exactly 1."""
    c, s = map(DoubleDouble, turns.T)
    length = hypotenuse(c, s)
    return c / length, s / length


ROUNDED = 16  # roundings of the coordinates by which the point of a normal may lie off the point of the ray


U = 2.0**-53
CHUNK = 1 << 14  # hits that are certified at once, so that their numbers stay in the processor's cache


class Rays(NamedTuple):
    """Rays and their hits."""

    origins: Array  # (n, 3)
    directions: Array  # (n, 3) of any length
    distances: Array  # (n,) in scene units
    normals: Array  # (n, 3)


class Certificate(NamedTuple):
    """Errors and condition numbers of n hits; NaN where nothing was hit."""

    backward_error: Array  # (n,) distance of o + t d from the surface, in units of 2^-53 (t + |o - c| + size)
    condition: Array  # (n,) relative change of t per relative change of the data
    normal_error: Array  # (n,) distance of the normal from the exact one at the nearest point of the surface


def certify(shapes: tuple[Shape, ...], owners: Integers, parts: Integers, rays: Rays) -> Certificate:
    """Certify n hits: ray i hits part `parts[i]` of the shape with the index `owners[i]`, or nothing if that is -1."""
    found = Certificate(*np.full((3, len(owners)), np.nan))
    kinds = np.array([type(shape) for shape in shapes], object)
    for kind in ALL_KINDS:
        members = np.flatnonzero(kinds == kind.element)
        hits = np.flatnonzero(np.isin(owners, members))
        if not len(hits):
            continue
        fields = exact_fields(kind, [shapes[i] for i in members])
        rows = fields.first_row[np.searchsorted(members, owners[hits])] + parts[hits]
        for start in range(0, len(hits), CHUNK):
            some, some_rows = hits[start : start + CHUNK], rows[start : start + CHUNK]
            with np.errstate(all="ignore"):
                certificate = certify_kind(kind, fields, some_rows, Rays(*(part[some] for part in rays)))
            for whole, part in zip(found, certificate, strict=True):
                whole[some] = part
    return found


def certify_kind(kind: Kind, fields: ExactFields, rows: Integers, rays: Rays) -> Certificate:
    """Certify n hits of shapes of one kind: ray i hits the shape in the row `rows[i]` of `fields`.

    The normal belongs to the point in the coordinates of the scene, rounded: at a rim it may be that of either face.
    """
    first = next(iter(fields.points.values()))[rows]  # point that the shape is given by
    magnitude = rays.distances + lengths_of(rays.origins - first) + fields.sizes[rows]
    # Scaled by a power of two all numbers are about 1, so that no product under- or overflows.
    power = -np.frexp(magnitude)[1]
    magnitude, distances = np.ldexp(magnitude, power), np.ldexp(rays.distances, power)
    rounding = ROUNDED * U * (magnitude + np.ldexp(np.abs(rays.origins).max(axis=1), power))
    d = exact_direction(rays.directions)
    point = exact_point(rays.origins, first, power) + distances * d
    shape = fields.shape(rows, first, power)
    normal = Vec(*rays.normals.T)
    distance, exact_normal, turned = foot(kind, shape, point, normal, rounding)
    cosine = exact_normal.x * d.x.high + exact_normal.y * d.y.high + exact_normal.z * d.z.high
    return Certificate(distance / (U * magnitude), magnitude / (distances * np.abs(cosine)), turned)
