"""Writes scene files: Scene -> text. What was read and did not change is written as it stood."""

from __future__ import annotations

import os
from collections.abc import Iterator

from minirt import atomic_write, regular_files
from minirt.scene import fast, files
from minirt.scene.line_rewriting import line_of
from minirt.scene.lines import BOM
from minirt.scene.pages import Item
from minirt.scene.scene import Scene


def dump(scene: Scene) -> str:
    """The text of a scene file."""
    lines = [line for page in scene.pages for line in lines_of(page.items)]
    return "\n".join(lines[:1] + [line.removeprefix(BOM) for line in lines[1:]])


def lines_of(items: tuple[Item, ...]) -> Iterator[str]:
    """The lines of a file that hold those items."""
    sources = [item if isinstance(item, str) else item.source for item in items]
    for item, source, said in zip(items, sources, fast.read(sources), strict=True):
        yield source if isinstance(item, str) or item == said else line_of(item)


def save(scene: Scene, path: str | os.PathLike[str]) -> None:
    """Writes a scene file, all of it or nothing; SceneError where that is not possible.

    An existing file keeps its permissions, and a symbolic link stays one.
    """
    files.check_name(path)
    data = dump(scene).encode()
    try:
        atomic_write.write(path, data)
    except (OSError, ValueError) as error:
        raise files.file_error(path, f"cannot be written: {regular_files.reason(error)}") from None
