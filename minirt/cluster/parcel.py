"""Scenes as parcels: a scene without the contents of its files, which it names by their digests.

Values travel as they are, not as text, since a direction that is normalised again may differ in its last bit.
"""

from __future__ import annotations

import hashlib
import io
import pickle
from collections.abc import Callable
from copy import copy
from functools import lru_cache
from typing import Any, NamedTuple, TypeVar

import numpy as np

from minirt.cluster import files
from minirt.element import Element, Record, fields_of
from minirt.errors import RenderError
from minirt.helpers import file_io
from minirt.meshes.triangles import Triangles
from minirt.scene import Scene

ARRAYS = ("points", "corners", "normals", "uvs")

Kind = TypeVar("Kind", bound=Record)


class Parcel(NamedTuple):
    """A scene that can be sent."""

    digest: str  # of all values, and of the contents of the files
    data: bytes  # pickle of the scene's elements
    files: tuple[str, ...]  # digests of the pictures and meshes


def pack(scene: Scene) -> Parcel:
    """Return the parcel of a scene, and keep its files by their digests.

    FileError where a file cannot be read, RenderError where one cannot be kept.
    """
    try:
        return packed(scene)
    except OSError as error:
        raise RenderError(
            f"the files of the scene cannot be kept in {files.folder()}: {error.strerror or error}"
        ) from None


def packed(scene: Scene) -> Parcel:
    """Return the parcel of a scene; OSError where a file cannot be kept."""
    used: dict[str, None] = {}

    def picture(name: str) -> str:
        digest = files.keep(file_io.read(scene.beside(name), file_io.LARGEST_ASSET))
        used[digest] = None
        return digest

    def mesh(triangles: Triangles) -> str:
        digest = kept_mesh(triangles)
        used[digest] = None
        return digest

    elements = tuple(renamed(each, picture) for each in scene.elements)
    buffer, digest = io.BytesIO(), hashlib.sha256()
    MeshPickler(buffer, mesh).dump(elements)
    values = MeshPickler(HashWriter(digest), mesh)
    values.fast = True  # equal values give equal bytes, whether they are the same object or not
    values.dump(elements)
    return Parcel(digest.hexdigest(), buffer.getvalue(), tuple(used))


def unpack(data: bytes) -> Scene:
    """Return the scene of a parcel, whose files are there."""
    return Scene(MeshUnpickler(io.BytesIO(data)).load(), files.folder() / "scene.rt")


def renamed(record: Kind, name: Callable[[str], str]) -> Kind:
    """Return an element, or a material of it, with other names of its picture files; itself where it has none."""
    changed = record
    for field in fields_of(type(record)):
        value = getattr(record, field.name)
        if value is None or not any(True for _ in field.pictures(value)):
            continue
        if changed is record:
            changed = copy(record)
            if isinstance(record, Element):
                object.__setattr__(changed, "source", "")
        new = name(value) if isinstance(value, str) else renamed(value, name)
        object.__setattr__(changed, field.name, new)  # unchecked: checking normalises the other values again
    return changed


class HashWriter(NamedTuple):
    """File whose bytes are hashed and not kept."""

    digest: Any

    def write(self, data: bytes) -> None:
        """Hash some bytes; `pickle` calls this."""
        self.digest.update(data)


class MeshPickler(pickle.Pickler):
    """Pickles scenes with the digests of meshes in place of their triangles."""

    def __init__(self, buffer: io.BytesIO | HashWriter, keep: Callable[[Triangles], str]) -> None:
        super().__init__(buffer, protocol=5)
        self.keep = keep

    def persistent_id(self, value: Any) -> str | None:
        """Return the digest of a mesh, None for any other object; `pickle` calls this."""
        return self.keep(value) if isinstance(value, Triangles) else None


class MeshUnpickler(pickle.Unpickler):
    """Reads scenes with digests of meshes."""

    def persistent_load(self, digest: str) -> Triangles:
        """Return the mesh with a digest; `pickle` calls this."""
        return loaded_mesh(digest)


@lru_cache(4)
def kept_mesh(triangles: Triangles) -> str:
    """Keep a mesh as a file and return its digest."""
    buffer = io.BytesIO()
    arrays = {name: getattr(triangles, name) for name in ARRAYS}
    np.savez(buffer, **{name: array for name, array in arrays.items() if array is not None})
    return files.keep(buffer.getvalue())


@lru_cache(4)
def loaded_mesh(digest: str) -> Triangles:
    """Return the mesh with a digest: the same object for each scene, so that its packed form can be used again."""
    with np.load(io.BytesIO(files.read(digest)), allow_pickle=False) as arrays:
        return Triangles(**dict(arrays))
