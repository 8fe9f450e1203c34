"""Identity of a picture: a hash of all that it depends on, which tells whether two programs render the same one."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator

from minirt.element import Element, fields_of
from minirt.fields import MeshFile
from minirt.helpers import file_io
from minirt.kernel.machine_code.fingerprint import V3, fingerprint_of
from minirt.scene import Scene, dump


def identity(scene: Scene, settings: str) -> str:
    """Return a hash of a scene, the files that it names, the settings and the kernel. FileError where a file cannot be
    read."""
    found = hashlib.sha256(f"{fingerprint_of(V3)} {settings}\n{dump(scene)}".encode())
    for name in sorted({name for element in scene.elements for name in files_of(element)}):
        data = file_io.read(scene.beside(name), file_io.LARGEST_ASSET)
        found.update(f"{name} {len(data)}\n".encode())
        found.update(data)
    return found.hexdigest()


def files_of(element: Element) -> Iterator[str]:
    """Yield the names of the pictures and meshes of an element, as the scene file has them."""
    for field in fields_of(type(element)):
        value = getattr(element, field.name)
        if isinstance(value, MeshFile):
            yield value.name
        elif value is not None:
            yield from (each.name for each in field.pictures(value))
