"""Reader of .stl, .ply, .gltf and .glb files by trimesh, an optional package, which gets what is within the limits.

It opens no files and decodes no pictures: these are read as those of .mtl files are.
"""

from __future__ import annotations

import io
import logging
import re
import warnings
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from minirt.errors import FileError
from minirt.helpers import file_io
from minirt.meshes import gltf
from minirt.meshes.named_files import Files, Look
from minirt.meshes.obj import NOT_FINITE, check_lines, check_triangles, parse
from minirt.meshes.obj_lines import ObjError
from minirt.meshes.triangles import Triangles

PLY_PICTURE = "picture"
LINE_ENDS = bytes.maketrans(b"\r\v\f\x1c\x1d\x1e\x85\xa8\xa9", b"\n" * 9)  # of Unicode, at which trimesh splits a text
LONGEST_HEADER = 2**20  # bytes of a .ply file
FACES = re.compile(rb"^\s*element\s+face\s+(\d{1,18})", re.MULTILINE)
EDGES = re.compile(rb"^(\s*element\s+)edge\b", re.MULTILINE)
PICTURE = re.compile(rb"^\s*comment\s+texturefile\s+(.*\S)", re.MULTILINE | re.IGNORECASE)

logging.getLogger("trimesh").addHandler(logging.NullHandler())  # without one, its warnings go to standard error


def read(path: Path) -> Triangles:
    """Return the triangles of a file, by way of an .obj file that trimesh writes.

    Parts of glTF files are flat unless they have normals, as glTF 2.0 asks for; other files have none. FileError where
    trimesh is missing or cannot read the file, ObjError where the file is beyond a limit or has no triangle.
    """
    try:
        import trimesh
        from trimesh.exchange.obj import export_obj
    except ImportError:
        raise FileError(path, "needs trimesh, which is not installed: pip install 'minirt[meshes]'") from None
    files, kind = Files(path), path.suffix.lower().removeprefix(".")
    data = file_io.read(path, file_io.LARGEST_ASSET)
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")  # about oddities of a file that is read
            data, kind, looks, has_normals = prepare(data, kind, files)
            is_gltf = kind == "gltf"
            files.check_pictures()
            usual = Look(picture=PLY_PICTURE if PLY_PICTURE in files.pictures else "")
            scene = trimesh.load_scene(io.BytesIO(data), kind, files, process=False, skip_materials=kind == "ply")
            parts = [part for part in scene.geometry.values() if hasattr(part, "faces")]
            is_finite = all(np.isfinite(part.vertices).all() for part in parts)
            for part in parts:
                part.copy = partial(part.copy, include_cache=has_normals)  # export_obj gets copies, with the normals
                if not is_gltf:
                    part.merge_vertices()  # and drop those that no face names
                elif part.visual.kind == "vertex":
                    shares = gltf.encoded(part.visual.vertex_colors / 255)
                    part.visual.vertex_colors = np.rint(255 * shares).astype(np.uint8)
            give_looks(parts, looks, usual)
            text, others = export_obj(scene, include_normals=has_normals, return_texture=True, digits=17)
    except (FileError, ObjError):
        raise
    except Exception:  # damaged files make trimesh raise anything
        raise FileError(path, "is no mesh that trimesh can read") from None
    for name, content in others.items():
        (files.folder / name).write_bytes(content)
    try:
        mesh = parse(text.encode(), files.folder)
    except ObjError as error:
        raise ObjError(error.message) from None  # without its place in a file that nobody has
    return mesh if is_finite or is_gltf else replace(mesh, notices=(NOT_FINITE, *mesh.notices))


def prepare(data: bytes, kind: str, files: Files) -> tuple[bytes, str, dict[str, Look], bool]:
    """Return a file of a kind, "glb" for one, as trimesh gets it: its bytes, its kind, looks of its materials by their
    names, and whether its normals count. FileError or ObjError where the file, or one that it names, is beyond a limit.
    """
    if kind in ("gltf", "glb"):
        data, looks, has_normals = gltf.prepare(data, files)
        return data, "gltf", looks, has_normals
    if kind == "ply":
        return prepare_ply(data, files), kind, {}, False
    check_lines(data)
    return data, kind, {}, False


def give_looks(parts: list[Any], looks: dict[str, Look], usual: Look) -> None:
    """Give the parts of a scene of trimesh their materials, and texture coordinates to all parts if some have them."""
    from trimesh.visual import TextureVisuals

    has_uvs = any(uvs_of(part) is not None for part in parts)
    for part in parts:
        if hasattr(part.visual, "material"):
            part.visual.material = looks.get(part.visual.material.name, usual)
        if has_uvs and uvs_of(part) is None:  # export_obj numbers all uvs as it does the points
            own = getattr(part.visual, "material", usual)
            part.visual = TextureVisuals(np.zeros((len(part.vertices), 2)), own)


def uvs_of(part: Any) -> Any:
    """Return the texture coordinates of a part of a scene of trimesh; None where it has none."""
    return getattr(part.visual, "uv", None)


def prepare_ply(data: bytes, files: Files) -> bytes:
    """Return a .ply file for trimesh; ObjError where it is beyond a limit, FileError where its picture is."""
    header = data[: max(0, data.find(b"end_header", 0, LONGEST_HEADER))]
    if faces := FACES.search(header):
        check_triangles(int(faces[1]))
    if b"ascii" in header:
        check_lines(data.translate(LINE_ENDS))
    if picture := PICTURE.search(header):
        files.add_picture(PLY_PICTURE, picture[1].decode("utf-8", "replace"))
    return EDGES.sub(rb"\1none", header) + data[len(header) :]  # trimesh takes minutes to make paths of edges
