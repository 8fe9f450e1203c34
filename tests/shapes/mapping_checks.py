"""Checks of `mapping`, interpreted and compiled, against the reference renderer."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numba import njit

import minirt.kernel.compiler.object_code  # noqa: F401  (registers what is compiled)
from minirt.kernel import scene_arrays
from minirt.kernel.compiler.pipeline import FLAGS
from minirt.lanes import Vec, load, save, splat, width
from minirt.shapes import Kind, Paraboloid, Shape
from tests.reference import uv_mapping
from tests.reference.uv_mapping import SurfacePoint, surface_point
from tests.shapes import execution_modes
from tests.shapes.examples import hits
from tests.shapes.execution_modes import array, vec
from tests.shapes.regimes import Array
from tests.skipping import skip_incomplete

U = 2.0**-53
AROUND = {"sphere", "cylinder", "cone", "paraboloid", "hyperboloid", "torus", "ellipsoid"}  # u = 1 is where u = 0 is


Evaluate = Callable[[Shape, Array, Array], SurfacePoint]


def table(shape: Shape, number: Any = np.float64) -> Any:
    """The row of a shape, as the kernel reads it."""
    return execution_modes.shape_rows([shape]).astype(scene_arrays.row_type(execution_modes.kind_of(shape), number))


def interpreted(shape: Shape, points: Array, normals: Array, formula: Any = None) -> SurfacePoint:
    """`mapping` of a shape, or another formula, interpreted."""
    formula = formula or execution_modes.kind_of(shape).mapping
    with np.errstate(all="ignore"):
        u, v, to_u, to_v = formula(scene_arrays.read(table(shape, points.dtype), 0), vec(points), vec(normals))
    u, v = (np.broadcast_to(each, points.shape[:-1]) for each in (u, v))
    return SurfacePoint(u, v, array(to_u, points), array(to_v, points))


@cache
def kernel() -> Any:
    """`mapping`, compiled with the flags of the renderer."""

    def run(table: Any, p: Any, n: Any, out: Any) -> None:
        for i in range(0, out.shape[1], width(out)):
            point = Vec(load(p[0], i), load(p[1], i), load(p[2], i))
            normal = Vec(load(n[0], i), load(n[1], i), load(n[2], i))
            u, v, to_u, to_v = scene_arrays.mapping(scene_arrays.read(table, 0), point, normal)
            save(u, out[0], i)
            save(v, out[1], i)
            save(splat(to_u.x, u), out[2], i)
            save(splat(to_u.y, u), out[3], i)
            save(splat(to_u.z, u), out[4], i)
            save(splat(to_v.x, u), out[5], i)
            save(splat(to_v.y, u), out[6], i)
            save(splat(to_v.z, u), out[7], i)

    return njit(**FLAGS)(run)


def compiled(shape: Shape, points: Array, normals: Array) -> SurfacePoint:
    """`mapping`, compiled; the number of points is a multiple of a packet's."""
    out = np.empty((8, len(points)), points.dtype)
    in_packets = (np.ascontiguousarray(each.T) for each in (points, normals))
    kernel()(table(shape, points.dtype), *in_packets, out)
    return SurfacePoint(out[0], out[1], out[2:5].T, out[5:].T)


MODES: dict[str, Evaluate] = {"interpreted": interpreted, "compiled": compiled}


class Case(NamedTuple):
    """A shape, 128 points of its surface with the normals there, and what the reference renderer says of them."""

    shape: Shape
    points: Array  # (128, 3)
    normals: Array
    right: SurfacePoint
    coordinates: float  # largest coordinate of its points


@cache
def cases(kind: Kind, size: float, offset: float) -> list[Case]:
    seen, found = hits(kind, 1, size, offset, shapes=8, rays=256), []
    for shape, points, normals, hit in zip(seen.shapes, seen.points, seen.normals, seen.hit, strict=True):
        some = np.resize(np.flatnonzero(hit), 128)
        try:
            right = surface_point(shape, points[some])
        except TypeError as error:
            skip_incomplete(f"{error}: with `surface_point` in {uv_mapping.__file__} its pictures are compared with it")
        found.append(Case(shape, points[some], normals[some], right, float(np.abs(points[some]).max())))
    return found


def lengths(vectors: Array) -> Array:
    found: Array = np.linalg.norm(vectors, axis=-1)
    return found


def check_places(case: Case, evaluate: Evaluate, size: float) -> None:
    """Assert that u and v are those of the reference, within the rounding of the point."""
    got = evaluate(case.shape, case.points, case.normals)
    over_u, over_v = got.u - case.right.u, got.v - case.right.v
    if case.shape.title in AROUND:
        over_u -= np.rint(over_u)
    off = lengths(over_u[:, None] * got.along_u + over_v[:, None] * got.along_v)
    assert off.max() <= 32 * U * (case.coordinates + 10 * size) * steepness(case.shape)


def steepness(shape: Shape) -> float:
    """Factor by which an error across the axis grows along a steep side whose v is the distance to the axis."""
    return np.hypot(1, 4 * shape.height / shape.diameter) if isinstance(shape, Paraboloid) else 1.0


def check_tangents(case: Case, evaluate: Evaluate, size: float) -> None:
    """Assert that the tangents are those of the reference."""
    got = evaluate(case.shape, case.points, case.normals)
    for along, right in ((got.along_u, case.right.along_u), (got.along_v, case.right.along_v)):
        assert lengths(along - right).max() <= 1e-6 * lengths(right).max()
