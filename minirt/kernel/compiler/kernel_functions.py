"""Registration of all functions that the kernel of a frame, and that of binning, call.

Outside this folder they are plain Python and call each other as they stand; numba finds the compiled form of each.
"""

from __future__ import annotations

import sys

from numba.extending import register_jitable

import minirt.lanes.compiled  # noqa: F401  (registers the operations of the formulas)
from minirt.kernel import atomic_counter, frame, scene_arrays, trace
from minirt.kernel.compiler import frame_operations, kind_dispatch, packed_shapes, unrolled_loop  # noqa: F401
from minirt.kernel.compiler.inlining import inline_functions_of
from minirt.kernel.compiler.options import INLINED
from minirt.kernel.culling import binning, light_buffer
from minirt.kernel.shading import (
    environment,
    fractal_noise,
    lights,
    pattern_shares,
    patterns,
    shade,
    specular,
    surfaces,
    texture_lookup,
    texturing,
    whitted,
)
from minirt.lanes import angle, largest, noise, power, vec
from minirt.shapes import ALL_KINDS, basis, compensated, flat_start, pyramid, quadric, shape, start, uv_mapping

REGISTERED = (
    whitted.ray_stack,
    trace.for_each_kind,
    trace.closest_of_kind,
    trace.unoccluded_by_kind,
    atomic_counter.fetch_add,
    frame.store_block,
    frame.frame,
    binning.project_all,
    binning.fill_bins,
    scene_arrays.by_reference,
)
register_jitable(**INLINED)(vec.cross)
for _module in (
    basis,
    compensated,
    flat_start,
    angle,
    largest,
    noise,
    power,
    quadric,
    uv_mapping,
    pyramid,
    shape,
    start,
    binning,
    light_buffer,
    scene_arrays,
    trace,
    specular,
    lights,
    texture_lookup,
    texturing,
    fractal_noise,
    pattern_shares,
    patterns,
    surfaces,
    shade,
    environment,
    whitted,
    frame,
    *(sys.modules[kind.intersect.__module__] for kind in ALL_KINDS),
):
    inline_functions_of(_module, besides=REGISTERED)
