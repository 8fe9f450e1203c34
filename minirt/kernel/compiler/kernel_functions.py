"""Registration of all functions that the kernels of a frame, of binning and of contrast call.

Outside this folder they are plain Python and call each other as they stand; numba finds the compiled form of each.
"""

from __future__ import annotations

import sys

from numba.extending import register_jitable

import minirt.lanes.compiled  # noqa: F401  (registers the operations of the formulas)
from minirt import lanes
from minirt.kernel import binning, frame, pixels, scene_arrays, shadow_rays, trace
from minirt.kernel.compiler import frame_operations, kind_dispatch, packed_shapes, unrolled_loop  # noqa: F401
from minirt.kernel.compiler.inlining import inline_functions_of
from minirt.kernel.compiler.options import INLINED
from minirt.kernel.shading import lights, patterns, shade, shadows, surfaces, texturing, whitted
from minirt.lanes import mathematics
from minirt.shapes import ALL_KINDS, compensated, frames, shape, start

REGISTERED = (
    whitted.ray_stack,
    trace.for_each_kind,
    trace.closest_of_kind,
    shadow_rays.unoccluded_by_kind,
    pixels.fetch_add,
    pixels.store_block,
    frame.frame,
    binning.project_all,
    binning.fill_bins,
    pixels.classify,
)
for _function in (
    lanes.cross,
    lanes.max_norm,
    scene_arrays.has_rows,
    scene_arrays.range_in_tile,
    scene_arrays.range_in_cell,
):
    register_jitable(**INLINED)(_function)
for _module in (
    compensated,
    frames,
    mathematics,
    shape,
    start,
    binning,
    trace,
    shadow_rays,
    lights,
    texturing,
    patterns,
    surfaces,
    shadows,
    shade,
    whitted,
    pixels,
    frame,
    *(sys.modules[kind.intersect.__module__] for kind in ALL_KINDS),
):
    inline_functions_of(_module, besides=REGISTERED)
