"""Writer of scene files: pages of items -> text. Unchanged lines, and blanks, comments and unchanged fields of changed
lines stay as they were read.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from minirt.element import Element, fields_of
from minirt.fields import Field, MeshFile
from minirt.helpers import file_io
from minirt.scene import fast, files
from minirt.scene.line_reader import read_values
from minirt.scene.lines import BOM, Log, Word, line_from, split_line
from minirt.scene.pages import Crowd, Page
from minirt.scene.registry import identify
from minirt.scene.value_reader import Slot
from minirt.shapes import Mesh


def describe(element: Element) -> str:
    """Return the element as a new line of a scene file; its source line is ignored."""
    fields = fields_of(type(element))
    written = [field for field in fields if not field.keyed or getattr(element, field.name) != field.default]
    return " ".join([element.code, *(field_text(field, element) for field in written)])


def field_text(field: Field, element: Element) -> str:
    """Return the text of a field in a line: `value` or `key:value`."""
    value = field.format(getattr(element, field.name))
    return f"{field.prefix}{value}" if field.keyed else value


def line_of(element: Element) -> str:
    """Return the element's source line with its changed fields rewritten.

    The line is a new one where the source has errors, or is that of another kind.
    """
    kind = type(element)
    line = line_from(1, element.source)
    log = Log("", lenient=False)
    words = split_line(line, log) if not {"\n", "\0"} & set(line.source) else None
    written = identify(words[0], line, log) if words else None
    slots, values = read_values(kind, words, line, log) if words and written is kind else ([], {})
    if not words or not values or log.errors:
        return describe(element)
    if all(getattr(element, field.name) == values.get(field.name, field.default) for field in fields_of(kind)):
        return line.source
    before, _, after = line.source.partition(line.text)
    return before + rewrite(line.text, element, words, slots, values) + after


def rewrite(text: str, element: Element, words: list[Word], slots: list[Slot], values: dict[str, Any]) -> str:
    """Return the line `text` with the values of the element in place of `values`, those of the line by field name.

    `words` are those of the line, `slots` its fields with the words that give them.
    """
    absent = [field for field in fields_of(type(element)) if field.name not in values]
    added = [field for field in absent if getattr(element, field.name) != field.default]
    # Columns at which a part begins and ends, and what takes its place: nothing for None.
    edits: list[tuple[int, int, str | None]] = []
    for keyed in (True, False):  # new attributes go to the end, positional fields behind the last one
        if any(field.keyed == keyed for field in added):
            new = [field_text(field, element) for field in (added if keyed else absent) if field.keyed == keyed]
            end = words[-1].end if keyed else max(slot.word.end for slot in slots if not slot.field.keyed)
            edits.append((end, end, " ".join(new)))
    for slot in slots:
        value = getattr(element, slot.field.name)
        if value is None or (slot.bare and value != values[slot.field.name]):
            edits.append((slot.word.column, slot.word.end, None if value is None else field_text(slot.field, element)))
        elif value != values[slot.field.name]:
            edits.append((slot.word.column + slot.start, slot.word.end, slot.field.format(value)))
    for start, end, replacement in sorted(edits, key=lambda edit: edit[0], reverse=True):  # so columns stay valid
        text = edited(text, start, end, replacement)
    return text


def edited(text: str, start: int, end: int, new: str | None) -> str:
    """Replace the text from column `start` to `end` by `new`, insert it behind a blank where they are equal, or delete
    it with the blanks before; after several spaces the word behind it keeps its column."""
    before, rest = text[: start - 1], text[end - 1 :]
    if new is None:
        return before.rstrip(" \t") + rest
    if start == end:
        return f"{before} {new}{rest}"
    following = rest.lstrip(" ")
    gap = len(rest) - len(following)
    if gap > 1 and following:
        gap = max(1, gap - (len(new) - (end - start)))
    return before + new + " " * gap + following


def text_of(pages: tuple[Page, ...]) -> str:
    """Return the text of a scene file."""
    length = sum(len(page.items) for page in pages)
    lines: list[str] = []
    for page in pages:
        if isinstance(page.items, Crowd):
            lines += page.items.sources
            continue
        sources = [item if isinstance(item, str) else item.source for item in page.items]
        for item, source, read in zip(page.items, sources, fast.read(sources, length), strict=True):
            lines.append(source if isinstance(item, str) or item == read else line_of(item))
    text = "\n".join(lines)
    return text if text.find(BOM, 1) < 0 else "\n".join(lines[:1] + [line.removeprefix(BOM) for line in lines[1:]])


def write(pages: tuple[Page, ...], path: str | os.PathLike[str]) -> None:
    """Write a scene file as a whole or not at all; SceneError when that fails.

    An existing file keeps its permissions, and a symbolic link stays one.
    """
    files.check_name(path)
    data = text_of(pages).encode()
    for file in {mesh.file for page in pages for mesh in page.of(Mesh) if mesh.file.is_new}:
        write_mesh(Path(path).parent / file.name, file)
    try:
        file_io.write(path, data)
    except (OSError, ValueError) as error:
        raise files.file_error(path, f"cannot be written: {file_io.reason(error)}") from None


def write_mesh(path: Path, file: MeshFile) -> None:
    """Write the file of a mesh of arrays; SceneError when that fails, or where another file has its name."""
    from minirt.meshes.from_arrays import obj_text

    data = obj_text(file.triangles)
    try:
        file_io.create(path, data)
    except FileExistsError:
        if file_io.stamps(path) and file_io.read(path, file_io.LARGEST_ASSET) == data:
            return
        raise files.file_error(path, "is another file: give the mesh another name, as in file='mesh.obj'") from None
    except (OSError, ValueError) as error:
        raise files.file_error(path, f"cannot be written: {file_io.reason(error)}") from None
