"""Interpreted functions that pack a scene, under the same names as in `minirt.kernel.functions`."""

from minirt.kernel.binning import fill_bins, move_shape, project_shapes
from minirt.kernel.bvh_build import collapse, divide
from minirt.kernel.mesh_triangles import place_triangles
from minirt.kernel.scene_arrays import to_single

__all__ = ["collapse", "divide", "fill_bins", "move_shape", "place_triangles", "project_shapes", "to_single"]
