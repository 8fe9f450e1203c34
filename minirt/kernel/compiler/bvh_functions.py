"""Registration of the functions of the BVH: building, traversal, and queries."""

from __future__ import annotations

from minirt.kernel.bvh import build, collapse, nodes, queries, traversal
from minirt.kernel.compiler import kernel_functions, packed_blocks, traversal_operations  # noqa: F401
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
