"""Triangle meshes and their Wavefront .obj files. A file is read once, and again when it has changed."""

from __future__ import annotations

from pathlib import Path

from minirt.errors import FileError
from minirt.helpers import file_io
from minirt.meshes.triangles import Triangles


@file_io.read_once
def load_mesh(path: Path) -> Triangles:
    """Return the triangles of an .obj file, the same object until the file changes; FileError when it is no mesh."""
    from minirt.meshes.obj import ObjError, parse

    try:
        return parse(file_io.read(path, file_io.LARGEST_ASSET), path.parent)
    except ObjError as error:
        raise FileError(path, str(error)) from None
