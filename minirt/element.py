"""The base of everything that a line of a scene file describes.

A subclass is a frozen dataclass whose attributes are declared with `minirt.fields.declare`, in the order of the
file's format; `code` is the identifier that the line begins with. A record is the same without a line of its own.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, fields, replace
from functools import cache
from itertools import repeat
from typing import Any, ClassVar, Self, TypeVar, cast

from minirt.errors import ElementError
from minirt.fields import Field, FieldError

Answer = TypeVar("Answer")
Kind = TypeVar("Kind", bound="Record")


def cached_per_kind(ask: Callable[[type[Kind]], Answer]) -> Callable[[type[Kind]], Answer]:
    """A function of a kind of element that works its answer out once."""
    return cast("Callable[[type[Kind]], Answer]", cache(ask))


@cached_per_kind
def fields_of(record: type[Record]) -> tuple[Field, ...]:
    """The table of its fields, in the order of the format: attributes are last."""
    found = (
        replace(attribute.metadata["field"], name=attribute.name)
        for attribute in fields(record)
        if "field" in attribute.metadata
    )
    return tuple(sorted(found, key=lambda field: field.keyed))


@cached_per_kind
def pattern(element: type[Element]) -> str:
    """How a line of the element is written: `C x,y,z dx,dy,dz fov [roll:degree]`; without what all of a sort have."""
    own = (each for each in fields_of(element) if not each.sort)
    places = [each.notation if each.required else f"[{each.notation}]" for each in own]
    return " ".join((element.code, *places))


@dataclass(frozen=True)
class Record:
    """Values of declared fields; ValueError where one is out of range."""

    title: ClassVar[str]  # what people call it

    def __post_init__(self) -> None:
        for each in fields_of(type(self)):
            value = getattr(self, each.name)
            if each.keyed and value is each.default:
                continue
            try:
                checked = each.check(value)
            except FieldError as error:
                raise ValueError(f"{self.title} {each.title} {error}") from None
            if checked is not value:
                object.__setattr__(self, each.name, checked)

    def replace(self, **changes: Any) -> Self:
        """The same with some fields changed."""
        return replace(self, **changes)


@dataclass(frozen=True)
class Element(Record):
    """One element of a scene; ElementError where two fields do not go together."""

    code: ClassVar[str]
    aliases: ClassVar[tuple[str, ...]] = ()  # what else a line may begin with
    plural: ClassVar[str]
    once: ClassVar[bool] = False  # at most one in a scene
    required: ClassVar[bool] = False  # at least one in a file
    source: str = field(default="", kw_only=True, compare=False, repr=False)  # its line as it stood in the file

    def __post_init__(self) -> None:
        super().__post_init__()
        conflict = self.conflict()
        if conflict:
            raise ElementError(" ".join((self.title, *conflict)))

    def conflict(self) -> tuple[str, str] | None:
        """The name of a field that does not go with the others, and what it must be; None where all are in order."""
        return None

    @classmethod
    def checked(cls, count: int, columns: dict[str, Iterable[Any]]) -> list[Self]:
        """That many elements at once, of values that their fields have checked, by name. Whether these go together is
        not asked.

        What is left out is kept by the class, once. Without a Python call for each: 0.5 us instead of 5 us an element.
        """
        first = object.__new__(cls)
        for name in columns:  # CPython keeps attributes without a dict, in half the space, where it knows their names
            object.__setattr__(first, name, None)
        made = list(map(object.__new__, repeat(cls, count)))
        for name, column in columns.items():
            deque(map(object.__setattr__, made, repeat(name), column), maxlen=0)
        return made
