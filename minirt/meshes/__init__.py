"""Triangle meshes and their Wavefront .obj files. A file is read once, and again when it has changed."""

from minirt.meshes.mesh_cache import load_mesh
from minirt.meshes.triangles import Triangles

__all__ = ["Triangles", "load_mesh"]
