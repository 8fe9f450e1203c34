"""Triangle meshes and their files: Wavefront .obj, and those that trimesh, an optional package, reads. A file is read
once, and again when it has changed."""

from __future__ import annotations

import atexit
import re
import shutil
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

import numpy as np

from minirt.errors import FileError
from minirt.helpers import file_io
from minirt.meshes.triangles import Triangles

GLTF = (".gltf", ".glb")
BY_TRIMESH = (".stl", ".ply", *GLTF)
HIGHLIGHT = re.compile(rb"(?m)^Ks .*$")  # a usual one of trimesh, which no file asks for


@file_io.read_once
def load_mesh(path: Path) -> Triangles:
    """Return the triangles of a mesh file, the same object until the file changes; FileError when it is no mesh."""
    from minirt.meshes.obj import ObjError, parse

    source = as_obj(path) if path.suffix.lower() in BY_TRIMESH else path
    try:
        return parse(file_io.read(source, file_io.LARGEST_ASSET), source.parent)
    except ObjError as error:
        raise FileError(path, str(error)) from None


def as_obj(path: Path) -> Path:
    """Convert a file by trimesh into an .obj file with materials and pictures, and return its path: in a folder that is
    deleted at the end of this process. FileError.

    Files of glTF have smooth normals where their points are shared.
    """
    try:
        import trimesh
        from trimesh.exchange.obj import export_obj
    except ImportError:
        raise FileError(path, "needs trimesh, which is not installed: pip install 'minirt[meshes]'") from None
    is_smooth = path.suffix.lower() in GLTF
    try:
        scene = trimesh.load_scene(str(path), process=not is_smooth)
        parts = scene.geometry.values()
        for part in [part for part in parts if any(has_uv(each) for each in parts) and not has_uv(part)]:
            own = getattr(part.visual, "material", None)  # export_obj numbers all uvs as it does the points
            part.visual = trimesh.visual.TextureVisuals(np.zeros((len(part.vertices), 2)), own)
        text, others = export_obj(scene, include_normals=is_smooth, return_texture=True, digits=17)
    except Exception:  # damaged files make trimesh raise anything
        raise FileError(path, "is no mesh that trimesh can read") from None
    folder = Path(mkdtemp(prefix="minirt-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    for name, data in {**others, "mesh.obj": text.encode()}.items():
        (folder / Path(name).name).write_bytes(HIGHLIGHT.sub(b"", data) if name.endswith(".mtl") else data)
    return folder / "mesh.obj"


def has_uv(part: Any) -> bool:
    """Whether a part of a scene of trimesh has texture coordinates."""
    return getattr(part.visual, "uv", None) is not None
