"""The field that names a mesh file. Such a file lies beside the scene file, or where a path from there leads."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

from minirt.errors import FieldError
from minirt.fields.field import Field
from minirt.fields.pictures import file_name


@dataclass(frozen=True)
class MeshFile:
    """The name of a mesh file as it is written, and what was read from it."""

    name: str
    triangles: Any = None  # `minirt.meshes.Triangles`; None for lines of no file, for which nobody looks


@dataclass(frozen=True, kw_only=True)
class MeshField(Field):
    """A mesh file, kept as it is written."""

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
