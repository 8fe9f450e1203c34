"""Compiled forms of the functions that Python calls, under their own names."""

from minirt.kernel import (
    binning,
    bvh_build,
    bvh_collapse,
    mesh_triangles,
    moving_camera,
    pixels,
    ray_batches,
    rectangles,
)
from minirt.kernel.frame import frame as interpreted_frame
from minirt.kernel.machine_code.library import CompiledFunction

project_shapes, move_shape = CompiledFunction(rectangles.project_shapes), CompiledFunction(binning.move_shape)
pack_frame, follow = CompiledFunction(moving_camera.pack_frame), CompiledFunction(moving_camera.follow)
place_triangles = CompiledFunction(mesh_triangles.place_triangles)
divide, collapse = CompiledFunction(bvh_build.divide), CompiledFunction(bvh_collapse.collapse)
trace_rays = CompiledFunction(ray_batches.trace_rays)
frame = CompiledFunction(interpreted_frame)
classify, copy_levels = CompiledFunction(pixels.classify), CompiledFunction(pixels.copy_levels)
