"""Scenes on their way to workers, which are other processes or other machines, and the work that is done there.

Values travel as they are, not as text, since a direction that is normalised again may differ in its last bit. Workers
on other machines get textures, too, under the hashes of their contents.
"""

from __future__ import annotations

import atexit
import hashlib
import pickle
import shutil
import sys
from collections.abc import Callable
from copy import copy
from dataclasses import replace
from functools import cache, lru_cache
from pathlib import Path
from tempfile import mkdtemp
from typing import Any, TypeVar

import minirt
from minirt.cluster.job import Job, Made, render_band
from minirt.element import Element, Record, fields_of
from minirt.errors import RenderError
from minirt.helpers import file_io
from minirt.kernel.machine_code.fingerprint import V3, fingerprint_of
from minirt.scene import Camera, Scene

SCENES = 4  # that are kept unpacked in memory

Kind = TypeVar("Kind", bound=Record)


@cache
def version() -> str:
    """Return the version of the program and of the sources of its kernels."""
    return f"{minirt.__version__} {fingerprint_of(V3)}"


def packed(scene: Scene, with_files: bool) -> bytes:
    """Return a scene as bytes, `with_files` with the contents of its textures; FileError where one cannot be read."""
    files: dict[str, bytes] = {}

    def keep(name: str) -> str:
        data = file_io.read(scene.beside(name), file_io.LARGEST_ASSET)
        digest = hashlib.sha256(data).hexdigest()
        files[digest] = data
        return digest

    place = None if with_files else (scene.file or Path("scene.rt")).absolute()
    elements = tuple(renamed(each, keep) if with_files else each for each in scene.elements)
    return pickle.dumps((elements, files, place), protocol=5)


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
        if isinstance(value, minirt.MeshFile):
            materials = tuple(renamed(each, name) for each in value.triangles.materials)
            new: Any = minirt.MeshFile(value.name, replace(value.triangles, materials=materials))
        else:
            new = name(value) if isinstance(value, str) else renamed(value, name)
        object.__setattr__(changed, field.name, new)  # unchecked: checking normalises the other values again
    return changed


@lru_cache(SCENES)
def unpacked(data: bytes) -> Scene:
    """Return a scene; its textures are written into this worker's folder."""
    elements, files, place = pickle.loads(data)
    for digest, content in files.items():
        if not (texture := folder() / digest).exists():
            file_io.write(texture, content)
    return Scene(elements, place or folder() / "scene.rt")


@cache
def folder() -> Path:
    """Return a folder for textures, which is deleted at the end of this process or, if it was killed, by dask.

    Threads that ask for it at once may get one each.
    """
    worker = dask_worker()
    path = mkdtemp(prefix="minirt-", dir=worker and worker.local_directory)
    atexit.register(shutil.rmtree, path, ignore_errors=True)
    return Path(path)


def work(asked: str, data: bytes, camera: Camera, band: Job) -> Made:
    """Render a band of a packed scene, with another camera. RenderError where this version is not the one `asked` for,
    which might draw other bits."""
    if asked != version():
        raise RenderError(f"a worker has another miniRT: {version()} in place of {asked}")
    scene = unpacked(data)
    settings = band.settings
    if settings.threads is None:
        settings = settings.replace(threads=share_of_cores())
    return render_band(band._replace(scene=scene.replace(scene.camera, camera), settings=settings))


def share_of_cores() -> int | None:
    """Return the number of threads that a dask worker has; None elsewhere: all processors."""
    worker = dask_worker()
    return worker and int(worker.state.nthreads)


def dask_worker() -> Any:
    """Return the dask worker that calls this, None elsewhere."""
    if "distributed" not in sys.modules:
        return None
    from distributed import get_worker

    try:
        return get_worker()
    except ValueError:  # not called by a worker
        return None
