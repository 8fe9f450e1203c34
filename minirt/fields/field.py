"""A field, and how an element declares one.

A field has its place in a line, or it is an attribute: it stands behind the others with its key, `mirror:0.3`, and may
be left out, at its default or absent (None).

A field knows how its value is spelled in a scene file (`parse`, `format`; `column` for many at once), what it may be
(`check`), what a lenient reader makes of a wrong spelling (`repair`) and how a key press changes it (`nudge`). Errors
are `FieldError`s that say what was expected, without the name of the field.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, NamedTuple

from minirt.errors import FieldError


class PictureFile(NamedTuple):
    """A picture file that a value names, as it is written there."""

    name: str
    heights: bool = False  # whether it is read as a height map
    part: int | None = None  # which component of the value it is, from 0


class Repair(NamedTuple):
    """Another spelling of a field that a lenient reader takes, and what that does: "rounds it to 1,2,3"."""

    text: str
    deed: str


@dataclass(frozen=True, kw_only=True)
class Field(ABC):
    """One field of an element; `name` and `default` are those of the dataclass attribute that declares it."""

    width: ClassVar[int] = 1  # components, with commas between them
    plain: ClassVar[str] = ""  # regular expression of spellings that `column` reads; empty where it reads none

    doc: str
    unit: str = ""
    step: float = 1.0  # what one key press changes, in `unit`, or as a factor for a length
    keyed: bool = False  # an attribute, written as `key:value` behind the other fields, and left out at its default
    key: str = ""  # of an attribute; the name where it is empty
    aliases: tuple[str, ...] = ()  # keys that mean the same
    bare: str = ""  # the value that the key alone stands for, where it may stand alone
    sort: str = ""  # of an attribute that all elements of a sort have: what those are called
    placeholder: str = ""  # what stands for the value of an attribute in the pattern of a line; its unit where empty
    feature: str = ""  # of an attribute of shapes: the feature of the kernel that draws it
    initial: Any = None  # what an editor begins with; of a length in the scene, how many times the usual one
    name: str = ""
    default: Any = None  # None: the field must be given, or as an attribute is absent

    @abstractmethod
    def parse(self, text: str) -> Any:
        """The value spelled by `text`, not yet checked."""

    def format(self, value: Any) -> str:
        """The spelling of `value` in a scene file."""
        return str(value)

    def check(self, value: Any) -> Any:
        """`value` in its normal form (a direction has unit length); FieldError where it is out of range."""
        return value

    def remark(self, value: Any) -> str:
        """What the reader of a file should be told of a value that is in range, or nothing."""
        return ""

    def column(self, texts: Sequence[str]) -> Sequence[Any]:
        """The checked values of many spellings that match `plain`; None for what is wrong or calls for a remark."""
        try:
            values = self.check_all(self.parse_all(texts))
        except ValueError:
            values = None
        return [self.quiet(text) for text in texts] if values is None else values

    def parse_all(self, texts: Sequence[str]) -> Sequence[Any]:
        """The values of many spellings that match `plain`, not yet checked; ValueError where one is wrong."""
        return [self.parse(text) for text in texts]

    def check_all(self, values: Sequence[Any]) -> Sequence[Any] | None:
        """Many values in their normal form. None or FieldError where that is not all that there is to say."""
        return None

    def quiet(self, text: str) -> Any:
        """The checked value spelled by `text`; None where it is wrong or calls for a remark."""
        try:
            value = self.parse(text)
            checked = self.check(value)
        except FieldError:
            return None
        return None if self.remark(value) else checked

    def repair(self, text: str) -> Repair | None:
        """What a lenient reader takes for the wrong spelling `text`, if anything."""
        return None

    def nudge(self, value: Any, steps: float) -> Any:
        """`value` after `steps` key presses, kept within its range."""
        return value

    def pictures(self, value: Any) -> Iterator[PictureFile]:
        """The picture files that `value` names."""
        return iter(())

    def feature_of(self, value: Any) -> str:
        """The feature that the kernel needs to draw `value`; empty where it has no effect."""
        return self.feature if value else ""

    @property
    def required(self) -> bool:
        """Whether it must be given."""
        return self.default is None and not self.keyed

    @property
    def title(self) -> str:
        """What it is called in messages."""
        return self.name.replace("_", " ")

    @property
    def keys(self) -> tuple[str, ...]:
        """The spellings of an attribute's key, the usual one first."""
        return (self.key or self.name, *self.aliases)

    @property
    def notation(self) -> str:
        """The field's place in the pattern of its line."""
        return f"{self.keys[0]}:{self.placeholder or self.unit or 'value'}" if self.keyed else self.name

    @property
    def range(self) -> str:
        """The range in words, for messages and documentation."""
        return ""


def declare(kind: Callable[..., Field], doc: str, **how: Any) -> Any:
    """A dataclass attribute that is a field of a scene element: `diameter: float = declare(Length, "...")`."""
    default = how.get("default")
    metadata = {"field": kind(doc=doc, **how)}
    given = default is None and not how.get("keyed")
    return field(metadata=metadata) if given else field(default=default, metadata=metadata)
