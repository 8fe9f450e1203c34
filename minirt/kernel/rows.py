"""How shapes lie in memory: for each kind an array with one row a shape.

A row holds the shape's index among all shapes, then the numbers of its packed form. The names of the row's fields begin
with the kind's, so that the type of an array tells which formulas belong to it.
"""

from __future__ import annotations

from functools import cache
from typing import Any, get_type_hints

import numpy as np

from minirt.lanes import Vec
from minirt.shapes import KINDS, Kind

Rows = Any  # an array of dtype `row_type(kind)`


@cache
def row_type(kind: Kind) -> np.dtype[Any]:
    """The dtype of the rows of a kind."""
    title = kind.element.title
    numbers = [
        (f"{title}.{name}", np.float64, (3,) if hint is Vec else ())
        for name, hint in get_type_hints(kind.packed).items()
    ]
    return np.dtype([(f"{title}.index", np.float64), *numbers], align=True)


def kind_of(fields: Any) -> Kind:
    """The kind to which a row with these field names belongs."""
    title = next(iter(fields)).split(".")[0]
    return next(kind for kind in KINDS if kind.element.title == title)


def row(index: int, packed: Any) -> tuple[Any, ...]:
    """The row of a packed shape."""
    return (index, *((part.x, part.y, part.z) if isinstance(part, Vec) else part for part in packed))


def index_of(rows: Rows, i: int) -> float:
    """The index among all shapes of the shape in row i."""
    return float(rows[i][0])


def read(rows: Rows, i: int) -> Any:
    """The packed shape in row i."""
    _, *parts = rows[i]
    return kind_of(rows.dtype.names).packed(*(Vec(*part) if np.ndim(part) else part for part in parts))


def kind_of_packed(packed: type[Any]) -> Kind:
    """The kind whose packed form a class is."""
    return next(kind for kind in KINDS if kind.packed is packed)


def intersect(shape: Any, origin: Vec, direction: Vec) -> Any:
    """`intersect` of the shape's own kind."""
    return kind_of_packed(type(shape)).intersect(shape, origin, direction)


def surface(shape: Any, point: Vec) -> Any:
    """`surface` of the shape's own kind."""
    return kind_of_packed(type(shape)).surface(shape, point)
