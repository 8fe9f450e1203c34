"""The formula of a kind of shape alone, compiled as it is for the kernel: for measuring it."""

from __future__ import annotations

import sys
from functools import cache
from math import inf
from typing import Any

from numba import njit
from numba.extending import register_jitable

from minirt.kernel.compiler.code_cache import FLAGS
from minirt.kernel.compiler.jit import INNER, own_functions
from minirt.kernel.rows import read
from minirt.lanes import Vec, load, save, where, width
from minirt.shapes import ALL_KINDS

KNOWN = {kind.intersect.__module__ for kind in ALL_KINDS}  # whose functions have a compiled form


@cache
def probe(formula: Any) -> Any:
    """`f(rows, each, origins, directions, distances, times)`: where rays meet shapes, by a formula like
    `Kind.intersect`, worked out so many times.

    Ray i of the m runs against the shape in row `i // each`; `each` is a multiple of a packet's rays. Origins and
    directions are (3, m); distances, (m,), become infinite where the ray misses. The precision is that of the arrays.
    """
    if formula.__module__ not in KNOWN:
        KNOWN.add(formula.__module__)
        for each in own_functions(sys.modules[formula.__module__]):
            register_jitable(**INNER)(each)

    def run(rows: Any, each: int, origins: Any, directions: Any, distances: Any, times: int) -> None:
        for _ in range(times):
            for i in range(0, distances.size, width(distances)):
                origin = Vec(load(origins[0], i), load(origins[1], i), load(origins[2], i))
                direction = Vec(load(directions[0], i), load(directions[1], i), load(directions[2], i))
                hit, t = formula(read(rows, i // each), origin, direction)
                save(where(hit, t, inf), distances, i)

    return njit(**FLAGS)(run)
