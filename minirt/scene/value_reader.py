"""Reader of values: words that are assigned to fields -> values of the fields, and the files that these name."""

from __future__ import annotations

import os
from collections.abc import Callable
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

from minirt.element import Element
from minirt.errors import FieldError, FileError, quoted
from minirt.fields import Direction, Field, MeshField, MeshFile, PictureFile
from minirt.helpers import file_io
from minirt.materials import pictures
from minirt.meshes import load_mesh
from minirt.scene.lines import Line, Log, Word
from minirt.shapes import Mesh

Notice = tuple[str, int | None]  # about a value, and the index of its component; None: about all of it


class Slot(NamedTuple):
    """A field of a kind of element, and the word that holds its value."""

    kind: type[Element]
    field: Field
    word: Word
    start: int = 0  # index of the value in the word, behind `key:`
    bare: bool = False  # whether the word is the key alone

    @property
    def title(self) -> str:
        """Name of the field in messages."""
        return f"{self.kind.title} {self.field.title}"

    @property
    def text(self) -> str:
        """Text of the value."""
        return self.field.bare if self.bare else self.word.text[self.start :]

    def span(self, part: int | None) -> tuple[int, int]:
        """Return column and length of component `part` of the value; None: of the whole value."""
        return self.word.span(part, self.start)


def parse_slots(slots: list[Slot], line: Line, log: Log) -> dict[str, Any]:
    """Parse the values of the fields, by name; one that is wrong is None, with an error."""
    return {slot.field.name: parse_slot(slot, line, log) for slot in slots}


def parse_slot(slot: Slot, line: Line, log: Log) -> Any:
    """Return the value of a field, with the file that it names; None when it is wrong, and errors go into the log.

    A wrong value that the field can repair is used so, with a notice.
    """
    field, text = slot.field, slot.text
    try:
        value = field.parse(text)
        checked = field.check(value)
        remark = field.remark(value)
        notices: list[Notice] = []
        if log.folder:
            checked, notices = with_files(slot, checked, log.folder)
    except FieldError as error:
        message, span = f"{slot.title} {error}", slot.span(error.part)
        repair = field.repair(text)
        if repair is None:
            log.error(line, message, *span)
            for each in error.further:
                log.error(line, f"{slot.title} {each}", *slot.span(each.part))
            return None
        log.notice(line, f"{message} (miniRT {repair.deed})", *span)
        return repair.value
    if remark and isinstance(field, Direction):  # which the file may have in many lines: told once for all of them
        log.change(line, remark, text)
    elif remark:
        log.notice(line, f"{slot.title} {remark}", *slot.span(None))
    for notice, part in notices:
        log.notice(line, f"{slot.title} {notice}", *slot.span(part))
    return checked


def with_files(slot: Slot, value: Any, folder: Path) -> tuple[Any, list[Notice]]:
    """Return a value with the mesh that it names, once its pictures were read, too, and notices about these files.

    FieldError for a file that cannot be used.
    """
    if isinstance(value, MeshFile):
        triangles, notices = load_file(load_mesh, PictureFile(value.name), slot, folder)
        about = [(f"{quoted(value.name)} {notice}", None) for notice in triangles.notices]
        return MeshFile(value.name, triangles), [*notices, *about]
    read = [load_file(pictures.reader(file), file, slot, folder)[1] for file in slot.field.pictures(value)]
    return value, [*chain.from_iterable(read)]


def load_file(read: Callable[[Path], Any], file: PictureFile, slot: Slot, folder: Path) -> tuple[Any, list[Notice]]:
    """Return what `read` returns for the path of a file that a value names, and notices about the file.

    The file is looked for in `folder`, that of the scene. FieldError when it cannot be used.
    """
    path, notices = file_io.located(folder, file.name), list[Notice]()
    try:
        content = read(path)
    except FileError as error:
        what = "" if isinstance(slot.field, MeshField) else "must be a picture file, got "
        raise FieldError(f"{what}{quoted(file.name)}: {error.reason}", file.part) from None
    if path != folder / file.name:
        above = quoted(os.path.relpath(path, folder))
        notices.append((f"is not beside the scene, and is read from {above}", file.part))
    if os.path.abspath(path) in pictures.transparent:  # noqa: PTH100
        notices.append(("has transparent parts, which are drawn opaque", file.part))
    return content, notices


def lacked_by(element: Element, field: Field) -> tuple[str, ...]:
    """Names of the fields without which an attribute has no effect, if the element has none of them.

    Meshes may have them in a file.
    """
    needs: tuple[str, ...] = field.facts.needs
    return () if isinstance(element, Mesh) or any(getattr(element, each) for each in needs) else needs


def tell_useless(element: Element, slots: list[Slot], line: Line, log: Log) -> None:
    """Add a notice for each attribute of a line that has no effect without another."""
    for slot in slots:
        if lacked := lacked_by(element, slot.field):
            keys = " or ".join(f"'{name.removesuffix('_map')}:'" for name in lacked)
            log.notice(line, f"{slot.title} has no effect without {keys}", *slot.word.span(None))
