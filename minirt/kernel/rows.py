"""Memory layout of packed shapes: one record array for each kind, with one row for each shape.

The names of a row's fields begin with the title of the kind: the dtype of an array tells which formulas belong to it.
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
    """Return the record dtype of the rows of a kind, with components of type `number`."""
    hints = get_type_hints(kind.packed).items()
    return np.dtype([(field_name(kind, name), number, (3,) if hint in (Vec, Position) else ()) for name, hint in hints])


def field_name(kind: Kind, name: str) -> str:
    """Return the name of the row field that holds a number or Vec of a packed shape."""
    return f"{kind.element.title}.{name}"


@cache
def point_fields(kind: Kind) -> tuple[str, ...]:
    """Return the names of the row fields that are points, not directions or numbers."""
    return tuple(field_name(kind, name) for name, hint in get_type_hints(kind.packed).items() if hint is Position)


def kind_of(fields: Any) -> Kind:
    """Return the kind whose rows have these field names."""
    title = next(iter(fields)).split(".")[0]
    return next(kind for kind in ALL_KINDS if kind.element.title == title)


def read(rows: Rows, i: int) -> Any:
    """Return the packed shape in row i."""
    parts = (Vec(*part) if np.ndim(part) else part for part in rows[i])
    return kind_of(rows.dtype.names).packed(*parts)


def kind_of_packed(packed: type[Any]) -> Kind:
    """Return the kind that has this class as its packed form."""
    return next(kind for kind in ALL_KINDS if kind.packed is packed)


def intersect(shape: Any, origin: Vec, direction: Vec) -> Any:
    """Intersect rays with a packed shape by the formula of its kind: `intersect` of `minirt.shapes.shape`."""
    return kind_of_packed(type(shape)).intersect(shape, origin, direction)


def occludes(shape: Any, origin: Vec, direction: Vec) -> Any:
    """Intersect shadow rays with a packed shape by the formula of its kind: `occludes` of `minirt.shapes.shape`."""
    kind = kind_of_packed(type(shape))
    return (kind.occludes or kind.intersect)(shape, origin, direction)


def mapping(shape: Any, point: Vec, normal: Vec) -> Any:
    """Compute texture coordinates and tangents by the formula of its kind: `mapping` of `minirt.shapes.shape`."""
    return kind_of_packed(type(shape)).mapping(shape, point, normal)


def shading(shape: Any, point: Vec, normal: Vec) -> Any:
    """Compute the shading normal by the formula of its kind: `shading` of `minirt.shapes.shape`."""
    return kind_of_packed(type(shape)).shading(shape, point, normal)


def smooth_point(shape: Any, point: Vec, normal: Vec) -> Any:
    """Move a point onto the smooth surface by the formula of its kind: `smooth_point` of `minirt.shapes.shape`."""
    return kind_of_packed(type(shape)).smooth_point(shape, point, normal)


def is_batched(rows: Rows) -> bool:
    """Whether the shapes of these rows are culled in batches, as the triangles of meshes are."""
    return kind_of(rows.dtype.names).batched


def may_meet(shape: Any, apex: Vec, start: Any, direction: Vec, active: Any) -> Any:
    """Cull rays of a packet by the test of its kind: `may_meet` of `minirt.shapes.shape`."""
    return kind_of_packed(type(shape)).may_meet(shape, apex, start, direction, active)


def surface(shape: Any, point: Vec) -> Any:
    """Compute surface point and normal by the formula of its kind: `surface` of `minirt.shapes.shape`."""
    return kind_of_packed(type(shape)).surface(shape, point)
