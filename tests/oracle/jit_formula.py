"""Compiled intersection formula of one kind of shape, for measurements of its error and its speed."""

from __future__ import annotations

import sys
from functools import cache
from math import inf
from typing import Any

from numba import njit

from minirt.kernel.compiler import object_code  # noqa: F401  (registers the formulas of all kinds)
from minirt.kernel.compiler.pipeline import FLAGS, inline_functions_of
from minirt.kernel.scene_arrays import read
from minirt.lanes import Vec, load, save, where, width
from minirt.shapes import ALL_KINDS

REGISTERED_MODULES = {kind.intersect.__module__ for kind in ALL_KINDS}


@cache
def probe(formula: Any) -> Any:
    """Compile `f(rows, rays_per_shape, origins, directions, distances, times)`, which intersects rays with shapes by a
    formula like `Kind.intersect`, again and again for as many `times`.

    Ray i of the m runs against the shape in row `i // rays_per_shape`, a multiple of a packet's rays. Origins and
    directions are (3, m); distances, (m,), become infinite where the ray misses. The precision is that of the arrays.
    """
    if formula.__module__ not in REGISTERED_MODULES:
        REGISTERED_MODULES.add(formula.__module__)
        inline_functions_of(sys.modules[formula.__module__])

    def run(rows: Any, rays_per_shape: int, origins: Any, directions: Any, distances: Any, times: int) -> None:
        for _ in range(times):
            for i in range(0, distances.size, width(distances)):
                origin = Vec(load(origins[0], i), load(origins[1], i), load(origins[2], i))
                direction = Vec(load(directions[0], i), load(directions[1], i), load(directions[2], i))
                hit, t = formula(read(rows, i // rays_per_shape), origin, direction)
                save(where(hit, t, inf), distances, i)

    return njit(**FLAGS)(run)
