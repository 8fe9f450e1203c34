"""Compiled BVH: building, traversal, and closest-hit queries of single rays."""

from __future__ import annotations

from numba import types

from minirt.kernel.bvh import build, collapse, nodes, queries, traversal
from minirt.kernel.compiler import kernel_functions, packed_blocks, traversal_operations  # noqa: F401
from minirt.kernel.compiler.compilation import CACHE, compiled
from minirt.kernel.compiler.inlining import inline_functions_of

REGISTERED = (
    nodes.packet_memory,
    nodes.put,
    nodes.integer_at,
    nodes.put_integer,
    nodes.tag,
    nodes.reference_of,
    nodes.bits,
    nodes.least_lane,
    queries.read_block,
    queries.read_one,
)
ENTRY_POINTS = (queries.trace_rays, build.divide, collapse.weigh, collapse.collapse)
for _module in (nodes, traversal, build, collapse, queries):
    inline_functions_of(_module, besides=REGISTERED + ENTRY_POINTS)

# Functions with types are compiled when this module is imported.
NUMBER, INTEGER = types.float64, types.int64
TABLE, LINKS = NUMBER[:, ::1], INTEGER[:, ::1]
BINARY_TREE = types.NamedTuple([TABLE, TABLE, LINKS, TABLE, NUMBER[::1], NUMBER[::1], LINKS], build.BinaryTree)
DIVIDE = INTEGER(BINARY_TREE)
WEIGH = types.void(BINARY_TREE, TABLE, LINKS)
COLLAPSE = types.UniTuple(INTEGER, 2)(BINARY_TREE, LINKS, NUMBER[::1], INTEGER[::1], LINKS, LINKS)

divide = compiled(build.divide, CACHE, DIVIDE)
weigh = compiled(collapse.weigh, CACHE, WEIGH)
collapse = compiled(collapse.collapse, CACHE, COLLAPSE)
trace_rays = compiled(queries.trace_rays, CACHE)
