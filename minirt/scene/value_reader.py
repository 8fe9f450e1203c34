"""Reader of values: words that are assigned to fields -> values of the fields, and the files that these name."""

from __future__ import annotations

import os
from collections.abc import Callable
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
    """Parse the value of a field; None, with an error, when it is wrong."""
    field, text = slot.field, slot.text
    try:
        value = field.parse(text)
        checked = field.check(value)
        remark = field.remark(value)
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
    if remark and isinstance(field, Direction):
        log.change(line, remark, text)
    elif remark:
        log.notice(line, f"{slot.title} {remark}", *slot.span(None))
    return value_with_files(slot, checked, line, log) if log.folder else checked


def value_with_files(slot: Slot, value: Any, line: Line, log: Log) -> Any:
    """Load the mesh that a value names, and try its pictures; an error for each file that cannot be used."""
    if isinstance(value, MeshFile):
        triangles = load_file(load_mesh, PictureFile(value.name), "mesh", slot, line, log)
        for notice in triangles.notices if triangles else ():
            log.notice(line, f"{slot.title} {quoted(value.name)} {notice}", *slot.span(None))
        return MeshFile(value.name, triangles)
    for file in slot.field.pictures(value):
        load_file(pictures.reader(file), file, "picture", slot, line, log)
    return value


def load_file(read: Callable[[Path], Any], file: PictureFile, sort: str, slot: Slot, line: Line, log: Log) -> Any:
    """Read a file that a value names; None, with an error, when it cannot be used."""
    try:
        folder = log.folder or Path()
        path = file_io.located(folder, file.name)
        content = read(path)
        if path != folder / file.name:
            above = quoted(os.path.relpath(path, folder))
            log.notice(line, f"{slot.title} is not beside the scene, and is read from {above}", *slot.span(file.part))
        if os.path.abspath(path) in pictures.transparent:  # noqa: PTH100
            log.notice(line, f"{slot.title} has transparent parts, which are drawn opaque", *slot.span(file.part))
        return content
    except FileError as error:
        message = f"{slot.title} must be a {sort} file, got {quoted(file.name)}: {error.reason}"
        if isinstance(slot.field, MeshField):
            message = f"{slot.title} {quoted(file.name)}: {error.reason}"
        log.error(line, message, *slot.span(file.part))
        return None


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
