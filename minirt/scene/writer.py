"""Writes scene files: Scene -> text. What was read and did not change is written as it stood."""

from __future__ import annotations

import os

from minirt import atomic
from minirt.scene import files
from minirt.scene.lines import BOM
from minirt.scene.rewriting import line_of
from minirt.scene.scene import Scene


def dump(scene: Scene) -> str:
    """The text of a scene file."""
    lines = [item if isinstance(item, str) else line_of(item) for item in scene.items]
    return "\n".join(lines[:1] + [line.removeprefix(BOM) for line in lines[1:]])


def save(scene: Scene, path: str | os.PathLike[str]) -> None:
    """Writes a scene file, all of it or nothing; SceneError where that is not possible.

    An existing file keeps its permissions, and a symbolic link stays one.
    """
    files.check_name(path)
    data = dump(scene).encode()
    try:
        atomic.write(path, data)
    except (OSError, ValueError) as error:
        raise files.refused(path, f"cannot be written: {files.reason(error)}") from None
