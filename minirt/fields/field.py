"""Base class of fields, and the fields of one word: a choice, and the names of pictures and meshes.

An element declares a field by `declare`. It is positional, or it is an attribute: attributes follow the other fields
with a key, `mirror:0.3`, and may be left out; then they have their default or are absent (None).

A field defines how its value is spelled in a scene file (`parse`, `format`), its range (`check`, and for arrays of
numbers `fits` and `values`), which wrong spellings have one meaning only (`repair`) and how a key press changes it
(`nudge`). Errors are `FieldError`s that say what was expected, without the name of the field.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

from minirt.errors import FieldError, quoted
from minirt.records import Immutable, record

FORBIDDEN = '\t\r\n\0#"'  # `#` begins a comment; a name with spaces is written within quotes


class PictureFile(NamedTuple):
    """A picture file that a value names, as written there."""

    name: str
    heights: bool = False  # whether it is read as a height map
    part: int | None = None  # index of the component of the value that names it
    sky: bool = False  # whether it is read as a sky, which may be a Radiance picture


class Repair(NamedTuple):
    """The value that a wrong spelling certainly means, and what taking it does: "drops the fourth component"."""

    value: Any
    deed: str


@record(kw_only=True)
class Field(Immutable):
    """One field of an element; `name` and `default` are those of the dataclass attribute that declares it."""

    width: ClassVar[int] = 1  # components, with commas between them
    number: ClassVar[type[float] | None] = None  # the type of a component; None if it is no number
    sort_of_value: ClassVar[str] = "a value"  # in messages

    doc: str
    unit: str = ""
    step: float = 1.0  # what one key press changes, in `unit`, or as a factor for a length
    keyed: bool = False  # an attribute: `key:value` behind the other fields, left out at its default
    key: str = ""  # of an attribute; the field's name if empty
    bare: str = ""  # the value that the key alone stands for, if it may stand alone
    sort: str = ""  # of an attribute that all elements of a sort have: the name of the sort
    placeholder: str = ""  # of an attribute: stands for its value in the format of a line; the unit if empty
    feature: str = ""  # of an attribute of shapes: the feature of the kernel that draws it
    packed: Callable[[Any, Any], Any] | None = None  # of the same: the row of a value in the array of its feature
    mapped: bool = False  # of an attribute of shapes: whether it lies on their surface, and turns with them
    needs: tuple[str, ...] = ()  # of an attribute: the names of others; without any of them it has no effect
    in_albedo: bool = False  # of an attribute of shapes: whether it changes their colour under white light
    initial: Any = None  # the editor's first value; of a length in the scene, as a factor of the usual one
    name: str = ""
    default: Any = None  # None: the field must be given, or as an attribute is absent

    def parse(self, text: str) -> Any:
        """The value spelled by `text`, not yet checked."""
        return text

    def format(self, value: Any) -> str:
        """The spelling of `value` in a scene file."""
        return str(value)

    def check(self, value: Any) -> Any:
        """`value` in its normal form, such as a direction of unit length; FieldError if it is out of range."""
        return value

    def of_flag(self, value: bool) -> Any:
        """The value that a program means by True: that of the key alone, as in a file; FieldError where none may stand
        alone, since True is the number 1, too."""
        if value and self.bare:
            return self.parse(self.bare)
        raise FieldError(f"must be {self.sort_of_value}, got {value}")

    def remark(self, value: Any) -> str:
        """A notice about a value that is in range but unusual; empty if there is none."""
        return ""

    def repair(self, text: str) -> Repair | None:
        """The checked value that the wrong `text` certainly means; None if there is none."""
        return None

    def nudge(self, value: Any, steps: float) -> Any:
        """`value` after `steps` key presses, clamped to its range."""
        return value

    def pictures(self, value: Any) -> Iterator[PictureFile]:
        """The picture files that `value` names."""
        return iter(())

    def features_of(self, value: Any) -> tuple[str, ...]:
        """The features that the kernel needs to draw `value`, the main one first; none if it has no effect."""
        return (self.feature,) if value else ()

    def rows(self, value: Any, _shape: Any, reader: Any) -> dict[str, Any]:
        """The rows of a shape with `value` in the arrays of the kernel, by feature: see `minirt.materials`."""
        return {self.feature: self.packed(value, reader)} if self.packed else {}

    @property
    def facts(self) -> Any:
        """The object that states the `needs` of an attribute and whether it is `in_albedo`: this field, or the class of
        a material with several values."""
        return self

    @property
    def required(self) -> bool:
        """Whether the field must be given."""
        return self.default is None and not self.keyed

    @property
    def title(self) -> str:
        """The field's name in messages."""
        return self.name.replace("_", " ")

    @property
    def keyword(self) -> str:
        """The key of an attribute: `mirror`, or `pattern:marble`."""
        return self.key or self.name

    @property
    def prefix(self) -> str:
        """Text before the value of an attribute in a line: `mirror:`, or `pattern:marble,`."""
        return self.keyword + ("," if ":" in self.keyword else ":")

    @property
    def example(self) -> str:
        """The editor's first value as a line spells it; '' where that is not made of numbers alone."""
        return self.format(self.initial) if isinstance(self.initial, float) else ""

    @property
    def notation(self) -> str:
        """The field in the format of its line."""
        return f"{self.prefix}{self.placeholder or self.unit or 'value'}" if self.keyed else self.name

    @property
    def range(self) -> str:
        """The range as text, for messages and documentation."""
        return ""


@record(kw_only=True)
class Choice(Field):
    """One of some words; a key press takes the next one, and the first one after the last."""

    words: tuple[str, ...]
    placeholder: str = "word"

    def check(self, value: str) -> str:
        if value not in self.words:
            raise FieldError(f"must be {', '.join(self.words[:-1])} or {self.words[-1]}, got {quoted(str(value))}")
        return value

    def nudge(self, value: str, steps: float) -> str:
        if not steps:
            return value
        return self.words[(self.words.index(value) + (1 if steps > 0 else -1)) % len(self.words)]


def file_name(text: str, also: str = "", sort: str = "picture") -> str:
    """Check the name of a file: FieldError if it cannot stand in a line, or has one of the characters in `also`."""
    if not isinstance(text, str) or not text.strip() or any(character in text for character in FORBIDDEN + also):
        commas = ", commas" if "," in also else ""
        raise FieldError(
            f"must be the name of a {sort} file, without tabs{commas}, quotes and #, got {quoted(str(text))}"
        )
    return text


def unquoted(text: str) -> str:
    """Return the name of a file that stands in a line within quotes, or without."""
    return text[1:-1] if len(text) > 1 and text[0] == text[-1] == '"' else text


def in_quotes(name: str) -> str:
    """Return the name of a file as it stands in a line: within quotes if it has blanks."""
    return f'"{name}"' if " " in name else name


@record(kw_only=True)
class Picture(Field):
    """A picture file, its name kept as written; `heights`: a height map, `also`: characters that it must not have."""

    placeholder: str = "file"
    heights: bool = False
    also: str = ""

    def parse(self, text: str) -> str:
        return unquoted(text)

    def format(self, value: str) -> str:
        return in_quotes(value)

    def check(self, value: str) -> str:
        return file_name(value, self.also)

    def pictures(self, value: str) -> Iterator[PictureFile]:
        yield PictureFile(value, self.heights)


@dataclass(frozen=True)
class MeshFile:
    """The name of a mesh file as written, and the triangles read from it."""

    name: str
    triangles: Any = None  # `minirt.meshes.Triangles`; None if it has not been read, as for lines without a scene file
    is_new: bool = False  # made of arrays: saving a scene writes the file


@record(kw_only=True)
class MeshField(Field):
    """A mesh file, its name kept as written."""

    def parse(self, text: str) -> MeshFile:
        return MeshFile(file_name(unquoted(text), sort="mesh"))

    def format(self, value: MeshFile) -> str:
        return in_quotes(value.name)

    def pictures(self, value: MeshFile) -> Iterator[PictureFile]:
        return value.triangles.pictures() if value.triangles else iter(())

    def check(self, value: MeshFile | str | os.PathLike[str]) -> MeshFile:
        if isinstance(value, MeshFile):
            return value
        if not isinstance(value, (str, os.PathLike)):
            raise FieldError(f"must be the name of a mesh file, got {value!r}")
        return self.parse(os.fspath(value))
