"""How shapes lie in memory: for each kind an array with one row a shape, its packed form number by number.

The names of a row's fields begin with the kind's, so that the type of an array tells which formulas belong to it.
"""

from __future__ import annotations

from functools import cache
from typing import Any, get_type_hints

import numpy as np

from minirt.lanes import Vec
from minirt.shapes import ALL_KINDS, Kind
from minirt.shapes.shape import Position

Rows = Any  # an array of dtype `row_type(kind)`


@cache
def row_type(kind: Kind, number: type = np.float64) -> np.dtype[Any]:
    """The dtype of the rows of a kind, made of numbers of a type."""
    hints = get_type_hints(kind.packed).items()
    return np.dtype([(field(kind, name), number, (3,) if hint in (Vec, Position) else ()) for name, hint in hints])


def field(kind: Kind, name: str) -> str:
    """What a number or Vec of a packed shape is called in the rows of its kind."""
    return f"{kind.element.title}.{name}"


@cache
def place_fields(kind: Kind) -> tuple[str, ...]:
    """The fields of the rows of a kind that are points."""
    return tuple(field(kind, name) for name, hint in get_type_hints(kind.packed).items() if hint is Position)


def kind_of(fields: Any) -> Kind:
    """The kind to which a row with these field names belongs."""
    title = next(iter(fields)).split(".")[0]
    return next(kind for kind in ALL_KINDS if kind.element.title == title)


def read(rows: Rows, i: int) -> Any:
    """The packed shape in row i."""
    parts = (Vec(*part) if np.ndim(part) else part for part in rows[i])
    return kind_of(rows.dtype.names).packed(*parts)


def kind_of_packed(packed: type[Any]) -> Kind:
    """The kind whose packed form a class is."""
    return next(kind for kind in ALL_KINDS if kind.packed is packed)


def intersect(shape: Any, origin: Vec, direction: Vec) -> Any:
    """`intersect` of the shape's own kind."""
    return kind_of_packed(type(shape)).intersect(shape, origin, direction)


def mapping(shape: Any, point: Vec, normal: Vec) -> Any:
    """`mapping` of the shape's own kind."""
    return kind_of_packed(type(shape)).mapping(shape, point, normal)


def shading(shape: Any, point: Vec, normal: Vec) -> Any:
    """`shading` of the shape's own kind."""
    return kind_of_packed(type(shape)).shading(shape, point, normal)


def is_batched(rows: Rows) -> bool:
    """Whether shapes of the kind of these rows come in crowds."""
    return kind_of(rows.dtype.names).batched


def may_meet(shape: Any, apex: Vec, start: Any, direction: Vec, asked: Any) -> Any:
    """`may_meet` of the shape's own kind."""
    return kind_of_packed(type(shape)).may_meet(shape, apex, start, direction, asked)


def surface(shape: Any, point: Vec) -> Any:
    """`surface` of the shape's own kind."""
    return kind_of_packed(type(shape)).surface(shape, point)
