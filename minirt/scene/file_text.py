"""Text of scene files: pages of items -> lines. Unchanged lines are written as they were read."""

from __future__ import annotations

import os
from collections.abc import Iterator

from minirt.helpers import file_io
from minirt.scene import fast, files
from minirt.scene.line_rewriting import line_of
from minirt.scene.lines import BOM
from minirt.scene.pages import Item, Page


def text_of(pages: tuple[Page, ...]) -> str:
    """Return the text of a scene file."""
    length = sum(len(page.items) for page in pages)
    lines = [line for page in pages for line in lines_of(page.items, length)]
    return "\n".join(lines[:1] + [line.removeprefix(BOM) for line in lines[1:]])


def lines_of(items: tuple[Item, ...], length: int) -> Iterator[str]:
    """Yield the lines of items of a file of `length` lines."""
    sources = [item if isinstance(item, str) else item.source for item in items]
    for item, source, read in zip(items, sources, fast.read(sources, length), strict=True):
        yield source if isinstance(item, str) or item == read else line_of(item)


def write(pages: tuple[Page, ...], path: str | os.PathLike[str]) -> None:
    """Write a scene file as a whole or not at all; SceneError when that fails.

    An existing file keeps its permissions, and a symbolic link stays one.
    """
    files.check_name(path)
    data = text_of(pages).encode()
    try:
        file_io.write(path, data)
    except (OSError, ValueError) as error:
        raise files.file_error(path, f"cannot be written: {file_io.reason(error)}") from None
