"""Mesh files that were read, kept for the next scene that names them."""

from __future__ import annotations

import os
from pathlib import Path
from threading import Lock

from minirt import regular_files
from minirt.errors import FileError
from minirt.meshes.obj import ObjError, parse
from minirt.meshes.triangles import Triangles

MAX_BYTES = 256 * 2**20  # bytes of a file

Stamp = tuple[int, int, int]  # what changes when a file does

cache: dict[str, tuple[Stamp, Triangles]] = {}
lock = Lock()


def load_mesh(path: str | os.PathLike[str]) -> Triangles:
    """The triangles of a Wavefront .obj file; the same object as long as the file is the same. FileError."""
    found = regular_files.status(path, MAX_BYTES)
    stamp = (found.st_ino, found.st_size, found.st_mtime_ns)
    key = os.path.abspath(path)  # noqa: PTH100 - a link is not followed: its target may change
    with lock:
        if key not in cache or cache[key][0] != stamp:
            cache.pop(key, None)
            cache[key] = stamp, read(Path(path))
        return cache[key][1]


def read(path: Path) -> Triangles:
    """The triangles of a file, read anew."""
    try:
        return parse(regular_files.read(path, MAX_BYTES))
    except ObjError as error:
        raise FileError(path, str(error)) from None
