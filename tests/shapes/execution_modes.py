"""The three execution modes of a shape's formulas: on single numbers, on arrays, and compiled."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
from numba import njit

import minirt.kernel.compiler.object_code  # noqa: F401  (registers what is compiled)
from minirt.kernel import scene_arrays
from minirt.kernel.compiler.pipeline import FLAGS
from minirt.kernel.machine_code.fingerprint import NATIVE, fingerprint_of
from minirt.kernel.machine_code.library import Call, Library, identity_of
from minirt.lanes import Vec, lane, load, save, where, width
from minirt.rendering.packing.packed_shapes import packed_rows
from minirt.shapes import KINDS, Kind, Shape
from tests.kernel.machine_code import small_kernels
from tests.kernel.machine_code.small_kernels import Compiler
from tests.shapes.regimes import RAYS, Array

U = 2.0**-53


@njit(**FLAGS)
def vec_lanes(points: Any, i: int) -> Vec:
    """Load a Vec on lanes from points (3, n)."""
    return Vec(load(points[0], i), load(points[1], i), load(points[2], i))


def on_lanes(function: Any, rows: int, *arguments: Any) -> Array:
    """Compile `function(i, *arguments)`, which returns a tuple of lanes; call it on all lanes of the last argument.

    Return its results, (rows, n).
    """
    out = np.full((rows, arguments[-1].shape[-1]), np.nan, arguments[-1].dtype)
    lanes_caller(function)(arguments, out)
    return out


@cache
def lanes_caller(function: Any) -> Any:
    """Return a compiled loop that calls a function for each packet of lanes."""
    inner = njit(**FLAGS)(function)

    @njit(**FLAGS)
    def run(arguments: Any, out: Any) -> None:
        for i in range(0, out.shape[1], width(out)):
            for row, result in enumerate(inner(i, *arguments)):
                save(result, out[row], i)

    return run


Intersect = Callable[[list[Shape], Array, Array], Array]


def kind_of(shape: Shape) -> Kind:
    return next(kind for kind in KINDS if kind.element is type(shape))


def vec(points: Array) -> Vec:
    """Vectors along the last axis of an array as a `Vec`; a single one has numpy numbers, whose division is IEEE
    754."""
    return Vec(points[..., 0], points[..., 1], points[..., 2])


def array(v: Vec, like: Array) -> Array:
    return np.stack([np.broadcast_to(part, like.shape[:-1]) for part in (v.x, v.y, v.z)], axis=-1)


def with_numpy_numbers(packed: Any) -> Any:
    """A packed shape with numpy numbers instead of Python's."""
    parts = (Vec(*map(np.float64, (p.x, p.y, p.z))) if isinstance(p, Vec) else np.float64(p) for p in packed)
    return type(packed)(*parts)


def on_numbers(shapes: list[Shape], origins: Array, directions: Array, formula: Any = None) -> Array:
    """t of rays (m, n, 3) against m shapes, infinity where they miss."""
    t = np.full(origins.shape[:2], np.inf)
    for i, shape in enumerate(shapes):
        packed = with_numpy_numbers(shape.pack())
        for j in range(origins.shape[1]):
            with np.errstate(all="ignore"):
                hit, at = (formula or kind_of(shape).intersect)(packed, vec(origins[i, j]), vec(directions[i, j]))
            t[i, j] = at if hit else np.inf
    return t


def on_arrays(shapes: list[Shape], origins: Array, directions: Array, formula: Any = None) -> Array:
    """t of rays (m, n, 3) against m shapes, all rays of a shape at once."""
    t = np.full(origins.shape[:2], np.inf)
    for i, shape in enumerate(shapes):
        with np.errstate(all="ignore"):
            hit, at = (formula or kind_of(shape).intersect)(
                with_numpy_numbers(shape.pack()), vec(origins[i]), vec(directions[i])
            )
        t[i] = np.where(hit, at, np.inf)
    return t


def shape_rows(shapes: list[Shape]) -> Any:
    """The rows of shapes of one kind, as the kernel reads them."""
    packed = np.ascontiguousarray(packed_rows([shape.pack() for shape in shapes]))
    return packed.view(scene_arrays.row_type(kind_of(shapes[0])))[:, 0]


def component_arrays(points: Array) -> Array:
    """Vectors (m, n, 3) as structure of arrays, as the kernel loads them: (3, m n)."""
    return np.ascontiguousarray(points.reshape(-1, 3).T, np.float64)


def closest(table: Any, each: int, o: Any, d: Any, t: Any) -> None:
    """Store t of rays, `each` of which go for one row of a table of shapes: what `compiled` compiles."""
    for i in range(0, t.shape[0], width(t)):
        origin = Vec(load(o[0], i), load(o[1], i), load(o[2], i))
        direction = Vec(load(d[0], i), load(d[1], i), load(d[2], i))
        hit, at = scene_arrays.intersect(scene_arrays.read(table, i // each), origin, direction)
        at = where(hit, at, np.inf)
        for ray in range(width(t)):
            t[i + ray] = lane(at, ray)


class SharedKernels(Library):
    """Kernels of tests, which are compiled once for all processes and runs until their file or the library changes."""

    def identity(self, call: Call) -> str:
        file = sys.modules[call[0].partition(":")[0]].__file__ or ""
        source = sha256(Path(file).read_bytes()).hexdigest()
        return identity_of(*call, f"{fingerprint_of(os.environ.get('NUMBA_CPU_NAME', NATIVE))} {source}")


KERNELS = SharedKernels()


def run_compiled(function: Callable[..., None], *arguments: Any) -> None:
    """Run the compiled form of a function of a module."""
    small_kernels.compiled(KERNELS, small_kernels.call(function, *arguments), Compiler())(*arguments)


def compiled(shapes: list[Shape], origins: Array, directions: Array) -> Array:
    """t of rays (m, n, 3) against m shapes, compiled as the renderer's; n is a multiple of the rays of a packet."""
    t = np.empty(origins.shape[:2])
    rays = component_arrays(origins), component_arrays(directions)
    run_compiled(closest, shape_rows(shapes), origins.shape[1], *rays, t.reshape(-1))
    return t


def surfaces(shapes: list[Shape], points: Array) -> tuple[Array, Array]:
    """`surface` of points (m, n, 3), interpreted: points on the surface and normals."""
    on, out = np.empty_like(points), np.empty_like(points)
    for i, shape in enumerate(shapes):
        with np.errstate(all="ignore"):
            point, normal = kind_of(shape).surface(with_numpy_numbers(shape.pack()), vec(points[i]))
        on[i], out[i] = array(point, points[i]), array(normal, points[i])
    return on, out


MODES: dict[str, Intersect] = {"numbers": on_numbers, "arrays": on_arrays, "compiled": compiled}


def shoot(intersect: Intersect, shape: Shape, *rays: tuple[tuple[float, ...], tuple[float, ...]]) -> list[float]:
    """t of rays, each an origin and a direction."""
    padded = [*rays, *[rays[-1]] * (-len(rays) % RAYS)]
    origins, directions = (np.array([ray[part] for ray in padded], float)[None] for part in (0, 1))
    return list(intersect([shape], origins, directions)[0, : len(rays)])
