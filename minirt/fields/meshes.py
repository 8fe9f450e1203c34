"""The field that names a mesh file, by a path that begins at the folder of the scene file."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

from minirt.errors import FieldError
from minirt.fields.field import Field
from minirt.fields.pictures import file_name
from minirt.records import record


@dataclass(frozen=True)
class MeshFile:
    """The name of a mesh file as written, and the triangles read from it."""

    name: str
    triangles: Any = None  # `minirt.meshes.Triangles`; None if it has not been read, as for lines without a scene file


@record(kw_only=True)
class MeshField(Field):
    """A mesh file, its name kept as written."""

    def parse(self, text: str) -> MeshFile:
        return MeshFile(file_name(text, sort="mesh"))

    def format(self, value: MeshFile) -> str:
        return value.name

    def check(self, value: MeshFile | str | os.PathLike[str]) -> MeshFile:
        if isinstance(value, MeshFile):
            return value
        if not isinstance(value, (str, os.PathLike)):
            raise FieldError(f"must be the name of a mesh file, got {value!r}")
        return self.parse(os.fspath(value))
