"""Interpreted functions that pack a scene, under the same names as in `minirt.kernel.functions`."""

from minirt.kernel.binning import move_shape
from minirt.kernel.bvh_build import divide
from minirt.kernel.bvh_collapse import collapse
from minirt.kernel.mesh_triangles import place_triangles
from minirt.kernel.moving_camera import follow, pack_frame
from minirt.kernel.rectangles import project_shapes

__all__ = ["collapse", "divide", "follow", "move_shape", "pack_frame", "place_triangles", "project_shapes"]
