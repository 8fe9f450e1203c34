"""The declared fields of shapes as double-double numbers, for the `boundary` of their kind."""

from __future__ import annotations

from types import SimpleNamespace
from typing import NamedTuple, get_type_hints

import numpy as np
from numpy.typing import NDArray

from minirt.element import fields_of
from minirt.fields import Angle, Direction, Length, Lengths, Point, cos_and_sin
from minirt.lanes import Vec
from minirt.shapes import Kind, Shape
from minirt.shapes.boundary import DoubleDouble, hypotenuse, unit
from minirt.shapes.compensated import two_sum
from minirt.shapes.shape import Position

Array = NDArray[np.float64]
Integers = NDArray[np.int64]
Columns = dict[str, Array]  # by the name of the field, a row for each shape, or for each part of it


class ExactFields(NamedTuple):
    """The numbers of shapes of one kind, in columns."""

    points: Columns  # (n, 3)
    lengths: Columns  # (n,) or (n, 3)
    directions: Columns  # (n, 3), of unit length but for rounding
    turns: Columns  # (n, 2) cosine and sine of an angle
    sizes: Array  # (n,) sum of the lengths and of the distances of the points from the first one
    first_row: Integers  # of each shape

    def first_point(self, rows: Integers) -> Array:
        """The first point that each shape is given by."""
        return next(iter(self.points.values()))[rows]

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
    """Collect the fields of shapes of a kind; for a batched kind, the points and directions of the packed form."""
    if kind.batched:
        points, lengths, directions = packed_columns(kind, shapes)
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
        if isinstance(each, Angle) and not kind.batched
    }
    first, *others = points.values()
    sizes = np.zeros(len(first))
    for each in lengths.values():
        sizes += each.reshape(len(each), -1).sum(axis=1)
    for each in others:
        sizes += lengths_of(each - first)
    first_row = np.concatenate([[0], np.cumsum([shape.parts for shape in shapes])[:-1]])
    return ExactFields(points, lengths, directions, turns, sizes, first_row)


def lengths_of(vectors: Array) -> Array:
    """The lengths of vectors (n, 3), none of which under- or overflows."""
    return np.hypot(np.hypot(vectors[:, 0], vectors[:, 1]), vectors[:, 2])


def packed_columns(kind: Kind, shapes: list[Shape]) -> tuple[Columns, Columns, Columns]:
    """The points, no lengths and the directions of all parts of shapes, in their packed form."""
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
