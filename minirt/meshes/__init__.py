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
    from minirt.meshes import by_trimesh
    from minirt.meshes.obj import ObjError, parse

    try:
        if path.suffix.lower() in BY_TRIMESH:
            return by_trimesh.read(path)
        return parse(file_io.read(path, file_io.LARGEST_ASSET), path.parent)
    except ObjError as error:
        raise FileError(path, str(error)) from None
