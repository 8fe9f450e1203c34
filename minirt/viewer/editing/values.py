"""What grows and shrinks of an element: its numbers, those of its attributes, its colours as a whole, and red, green
and blue of them. Of a picture there is a next one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from minirt.element import Element, Record, fields_of
from minirt.fields import Colour, Field, MeshField, MeshFile, Picture

COLOURS = "red", "green", "blue"

Another = Callable[[Any, float], Any]  # the picture or mesh that so many key presses lead to from one


class Value(NamedTuple):
    """A field of an element; or of the record that is the value of one; or one component of either."""

    field: Field  # of the element
    inner: Field | None = None  # of the record
    colour: int | None = None  # 0, 1, 2: red, green, blue
    start: int = 0  # components of the record before the inner field

    @property
    def name(self) -> str:
        """What the user sees."""
        title = f"{self.field.title} {self.inner.title}" if self.inner else self.field.title
        return title if self.colour is None else f"{title}: {COLOURS[self.colour]}"

    @property
    def range(self) -> str:
        """The range in words."""
        return (self.inner or self.field).range

    @property
    def part(self) -> int | None:
        """Which component of the field it is, from 0; None for all."""
        return None if self.inner is None and self.colour is None else self.start + (self.colour or 0)

    def nudged(self, element: Element, steps: float, another: Another) -> Any:
        """What becomes of the field after so many key presses."""
        old = self.of(element)
        new = another(old, steps) if isinstance(old, str | MeshFile) else (self.inner or self.field).nudge(old, steps)
        if self.colour is not None:
            new = (*old[: self.colour], new[self.colour], *old[self.colour + 1 :])
        return getattr(element, self.field.name).replace(**{self.inner.name: new}) if self.inner else new

    def of(self, element: Element) -> Any:
        """What it is now; of a component the whole colour."""
        value = getattr(element, self.field.name)
        return getattr(value, self.inner.name) if self.inner else value


def values(element: Element) -> tuple[Value, ...]:
    """All of them, the components of colours behind everything else."""
    whole = [value for field in fields_of(type(element)) for value in within(field, getattr(element, field.name))]
    whole.sort(key=lambda value: isinstance(value.field, MeshField))  # the size of a mesh comes before its file
    fields = ((value, value.inner or value.field) for value in whole)
    colours = [value for value, field in fields if isinstance(field, Colour) and not isinstance(value.of(element), str)]
    return (*whole, *(value._replace(colour=part) for value in colours for part in range(3)))


def within(field: Field, value: Any) -> Iterator[Value]:
    """Those of a field of an element; none where it is absent."""
    if isinstance(value, Record):
        start = 0
        for inner in fields_of(type(value)):
            if grows(inner):
                yield Value(field, inner, start=start)
            start += inner.width
    elif grows(field) and value is not None:
        yield Value(field)


def grows(field: Field) -> bool:
    """Whether key presses change values of the field."""
    return type(field).nudge is not Field.nudge or isinstance(field, Picture | MeshField)
