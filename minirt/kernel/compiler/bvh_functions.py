"""Registration of the functions of the BVH: building, traversal, and queries."""

from __future__ import annotations

from minirt.kernel import bvh_build, bvh_nodes, bvh_traversal
from minirt.kernel.compiler import kernel_functions, packed_blocks, traversal_operations  # noqa: F401
from minirt.kernel.compiler.inlining import inline_functions_of

REGISTERED = (
    bvh_nodes.packet_memory,
    bvh_nodes.put,
    bvh_nodes.integer_at,
    bvh_nodes.put_integer,
    bvh_nodes.tag,
    bvh_nodes.reference_of,
    bvh_nodes.bits,
    bvh_nodes.least_lane,
    bvh_traversal.read_block,
    bvh_traversal.read_one,
)
ENTRY_POINTS = (bvh_traversal.trace_rays, bvh_build.divide, bvh_build.weigh, bvh_build.collapse)
for _module in (bvh_nodes, bvh_build, bvh_traversal):
    inline_functions_of(_module, besides=REGISTERED + ENTRY_POINTS)
