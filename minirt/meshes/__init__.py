"""Triangle meshes and their Wavefront .obj files. A file is read once, and again when it has changed."""

from __future__ import annotations

import os
from pathlib import Path

from minirt.errors import FileError
from minirt.helpers import file_io
from minirt.helpers.system import ForkSafeLock
from minirt.meshes.triangles import Triangles

MAX_BYTES = 256 * 2**20  # 256 MiB

Stamp = tuple[int, int, int]  # inode, size and modification time (ns) of a file

cache: dict[str, tuple[Stamp, Triangles]] = {}
lock = ForkSafeLock()


def load_mesh(path: str | os.PathLike[str]) -> Triangles:
    """Return the triangles of an .obj file, the same object until the file changes; FileError when it is no mesh."""
    status = file_io.status(path, MAX_BYTES)
    stamp = (status.st_ino, status.st_size, status.st_mtime_ns)
    key = os.path.abspath(path)  # noqa: PTH100 - a link is not followed: its target may change
    with lock:
        if key not in cache or cache[key][0] != stamp:
            cache.pop(key, None)
            cache[key] = stamp, read(Path(path))
        return cache[key][1]


def read(path: Path) -> Triangles:
    """Read and parse an .obj file; FileError when it is no mesh."""
    from minirt.meshes.obj import ObjError, parse

    try:
        return parse(file_io.read(path, MAX_BYTES))
    except ObjError as error:
        raise FileError(path, str(error)) from None
