"""Base classes of all elements of a scene: what one line of a scene file describes.

A subclass is a record whose attributes are declared with `minirt.fields.declare`, in the order of the file's
format; `code` is the identifier at the beginning of the line. A record has declared fields, too, but no line of its
own.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import field, fields, replace
from itertools import repeat
from typing import Any, ClassVar, Self, TypeVar

from minirt.errors import ElementError
from minirt.fields import Field, FieldError
from minirt.records import Immutable, cached_per_kind, record

Kind = TypeVar("Kind", bound="Element")


@cached_per_kind
def fields_of(record: type[Record]) -> tuple[Field, ...]:
    """The declared fields of a record, in the order of the format: attributes are last."""
    declared = (replace(each.metadata["field"], name=each.name) for each in fields(record) if "field" in each.metadata)
    return tuple(sorted(declared, key=lambda field: field.keyed))


@cached_per_kind
def positional_fields(record: type[Record]) -> tuple[Field, ...]:
    """The fields of a record that have no key."""
    return tuple(field for field in fields_of(record) if not field.keyed)


@cached_per_kind
def fields_by_key(record: type[Record]) -> dict[str, Field]:
    """The attributes of a record by their keys."""
    return {field.keyword: field for field in fields_of(record) if field.keyed}


@cached_per_kind
def pattern(element: type[Element]) -> str:
    """The format of an element's line, `C x,y,z dx,dy,dz fov [roll:degree]`, without attributes that a sort shares."""
    own = (field for field in fields_of(element) if not field.sort)
    parts = [field.notation if field.required else f"[{field.notation}]" for field in own]
    return " ".join((element.code, *parts))


@record()
class Record(Immutable):
    """Values of declared fields. ElementError if one is out of range."""

    title: ClassVar[str]  # its name in messages and documentation
    _other_names: ClassVar[Mapping[str, Iterable[str]]] = {
        "size": ("sizes", "diameter", "side", "scale"),
        "radius": ("diameter",),
        "position": ("centre", "apex", "vertex", "point"),
        "direction": ("axis", "normal"),
    }

    def __post_init__(self) -> None:
        for each in fields_of(type(self)):
            value = getattr(self, each.name)
            if each.keyed and value is each.default:
                continue
            try:
                checked = each.check(each.of_flag(value) if isinstance(value, bool) else value)
            except FieldError as error:
                raise ElementError(f"{self.title} {each.title} {error}") from None
            if checked is not value:
                object.__setattr__(self, each.name, checked)

    def replace(self, **changes: Any) -> Self:
        """A copy with some fields changed."""
        return replace(self, **changes)


@record()
class Element(Record):
    """One element of a scene. ElementError if two of its fields contradict each other."""

    code: ClassVar[str]
    aliases: ClassVar[tuple[str, ...]] = ()  # other identifiers that a line may begin with
    plural: ClassVar[str]
    once: ClassVar[bool] = False  # at most one in a scene
    required: ClassVar[bool] = False  # at least one in a file
    source: str = field(default="", kw_only=True, compare=False, repr=False)  # its line in the file, verbatim

    def __post_init__(self) -> None:
        super().__post_init__()
        conflict = self.conflict()
        if conflict:
            raise ElementError(" ".join((self.title, *conflict)))

    def as_kind(self, kind: type[Kind]) -> Kind:
        """An element of another kind with the same fields, such as a further light for a light."""
        values = {each.name: getattr(self, each.name) for each in fields(self)}
        return kind(**values | {"source": ""})

    def conflict(self) -> tuple[str, str] | None:
        """A field that contradicts the others, by name, and what it must be; None if there is none."""
        return None

    @classmethod
    def of_columns(cls, count: int, columns: dict[str, Iterable[Any]]) -> list[Self]:
        """Make `count` elements from columns of their values, by field name, without a check of any.

        The values are in the normal form of their fields, as `Field.check` returns them, and do not contradict each
        other. Fields without a column have the defaults of the class. There is no Python call for each element: 0.5 us
        instead of 5 us an element.
        """
        # CPython keeps attributes without a dict, in half the space, of objects made after it has met their names.
        first = object.__new__(cls)
        for name in columns:
            object.__setattr__(first, name, None)
        elements = list(map(object.__new__, repeat(cls, count)))
        for name, column in columns.items():
            deque(map(object.__setattr__, elements, repeat(name), column), maxlen=0)
        return elements
