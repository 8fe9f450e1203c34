"""Triangle meshes and their files: Wavefront .obj, and those that trimesh, an optional package, reads. A file is read
once, and again when it has changed."""

from __future__ import annotations

from pathlib import Path

from minirt.errors import FileError
from minirt.helpers import file_io
from minirt.meshes.triangles import Triangles

BY_TRIMESH = (".stl", ".ply", ".gltf", ".glb")


@file_io.read_once
def load_mesh(path: Path) -> Triangles:
    """Return the triangles of a mesh file, the same object until the file changes; FileError when it is no mesh."""
    from minirt.meshes.by_trimesh import as_obj
    from minirt.meshes.obj import ObjError, parse

    try:
        is_obj = path.suffix.lower() not in BY_TRIMESH
        return parse(*(file_io.read(path, file_io.LARGEST_ASSET), path.parent) if is_obj else as_obj(path))
    except ObjError as error:
        raise FileError(path, str(error)) from None
