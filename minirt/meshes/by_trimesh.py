"""Reader of .stl, .ply, .gltf and .glb files by trimesh, an optional package, which gets what is within the limits.

It opens no files and decodes no pictures: these are read as those of .mtl files are.
"""

from __future__ import annotations

import atexit
import base64
import io
import logging
import re
import shutil
import warnings
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from tempfile import mkdtemp
from typing import Any
from urllib.parse import unquote

import numpy as np

from minirt.errors import FileError
from minirt.helpers import file_io
from minirt.helpers.system import TooLargeError
from minirt.materials import pictures
from minirt.meshes.obj import check_lines, check_triangles
from minirt.meshes.obj_lines import ObjError

WHITE = (1.0, 1.0, 1.0)
PLY_PICTURE = "picture"
LINE_ENDS = bytes.maketrans(b"\r\v\f\x1c\x1d\x1e\x85\xa8\xa9", b"\n" * 9)  # of Unicode, at which trimesh splits a text
LONGEST_HEADER = 2**20  # bytes of a .ply file
FACES = re.compile(rb"^\s*element\s+face\s+(\d{1,18})", re.MULTILINE)
EDGES = re.compile(rb"^(\s*element\s+)edge\b", re.MULTILINE)
PICTURE = re.compile(rb"^\s*comment\s+texturefile\s+(.*\S)", re.MULTILINE | re.IGNORECASE)

logging.getLogger("trimesh").addHandler(logging.NullHandler())  # without one, its warnings go to standard error


@dataclass(frozen=True)
class Look:
    """A material of trimesh, as far as .obj files are written with it."""

    colour: tuple[float, ...] = WHITE
    picture: str = ""
    name: str = "look"

    def to_obj(self, name: str) -> tuple[dict[str, bytes], str]:
        """Return files of materials by their names, and the name of the material in them."""
        lines = [f"newmtl {name}", "Kd {} {} {}".format(*self.colour), *[f"map_Kd {self.picture}"] * bool(self.picture)]
        return {f"{name}.mtl": "\n".join(lines).encode()}, name

    def copy(self) -> Look:
        """Return the same, which does not change."""
        return self


class Files:
    """The files that a mesh names, and the folder of its pictures."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.contents: dict[str, bytes] = {}
        self.pictures: dict[str, int] = {}  # sizes in bytes, 0 of those that are not there

    def get(self, uri: str) -> bytes:
        """Return the bytes in a URI, or in the file that it names; FileError."""
        if uri.startswith("data:"):
            return self.contents.setdefault(uri, base64.b64decode(uri.partition(",")[2]))
        if uri not in self.contents:
            try:
                self.contents[uri] = file_io.read(self.path.parent / unquote(uri), file_io.LARGEST_ASSET)
            except FileError as error:
                raise FileError(self.path, f"names a file that cannot be used: {error.reason}") from None
            file_io.check_size(self.path, sum(map(len, self.contents.values())), file_io.LARGEST_ASSET)
        return self.contents[uri]

    __getitem__ = get

    def add_picture(self, name: str, uri: str, part: slice = slice(None)) -> None:
        """Write a picture, a part of the bytes of a URI, into the folder unless it is not there; FileError."""
        is_there = uri in self.contents or uri.startswith("data:") or file_io.found(self.path.parent / unquote(uri))
        data = self.get(uri)[part] if is_there else b""
        self.pictures[name] = len(data)
        file_io.check_size(self.path, sum(self.pictures.values()), file_io.LARGEST_ASSET)
        if is_there:
            (self.folder / name).write_bytes(data)

    def check_pictures(self) -> None:
        """Check the pictures by their headers; FileError."""
        try:
            pictures.check_headers(self.folder / name for name, size in self.pictures.items() if size)
        except FileError as error:
            raise FileError(self.path, f"has a picture that cannot be used: {error.reason}") from None
        except TooLargeError as error:
            raise FileError(self.path, str(error)) from None

    @cached_property
    def folder(self) -> Path:
        """A folder that is deleted at the end of this process."""
        folder = Path(mkdtemp(prefix="minirt-"))
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
        return folder


def as_obj(path: Path) -> tuple[bytes, Path]:
    """Convert a file by trimesh: an .obj file, and the folder of its materials and pictures; FileError, ObjError.

    Files of glTF have smooth normals where their points are shared.
    """
    try:
        import trimesh
        from trimesh.exchange.obj import export_obj
    except ImportError:
        raise FileError(path, "needs trimesh, which is not installed: pip install 'minirt[meshes]'") from None
    from minirt.meshes import gltf

    files, kind = Files(path), path.suffix.lower().removeprefix(".")
    data, is_smooth = file_io.read(path, file_io.LARGEST_ASSET), kind in ("gltf", "glb")
    looks: dict[str, Look] = {}
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")  # about oddities of a file that is read
            if is_smooth:
                kind, (data, looks) = "gltf", gltf.prepare(data, files)
            elif kind == "ply":
                data = prepare_ply(data, files)
            else:
                check_lines(data)
            files.check_pictures()
            usual = Look(picture=PLY_PICTURE * (PLY_PICTURE in files.pictures))
            scene = trimesh.load_scene(
                io.BytesIO(data), kind, files, process=not is_smooth, skip_materials=kind == "ply"
            )
            parts = [part for part in scene.geometry.values() if hasattr(part, "faces")]
            has_uvs = any(uvs_of(part) is not None for part in parts)
            for part in parts:
                if hasattr(part.visual, "material"):
                    part.visual.material = looks.get(part.visual.material.name, usual)
                if has_uvs and uvs_of(part) is None:  # export_obj numbers all uvs as it does the points
                    own = getattr(part.visual, "material", usual)
                    part.visual = trimesh.visual.TextureVisuals(np.zeros((len(part.vertices), 2)), own)
            text, others = export_obj(scene, include_normals=is_smooth, return_texture=True, digits=17)
    except (FileError, ObjError):
        raise
    except Exception:  # damaged files make trimesh raise anything
        raise FileError(path, "is no mesh that trimesh can read") from None
    for name, content in others.items():
        (files.folder / name).write_bytes(content)
    return text.encode(), files.folder


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
