"""What grows and shrinks of an element: its numbers, those of its attributes, its colours as a whole, and red, green
and blue of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from minirt.element import Element, Record, fields_of
from minirt.fields import Colour, Field

COLOURS = "red", "green", "blue"


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

    def nudged(self, element: Element, steps: float) -> Any:
        """What becomes of the field after so many key presses."""
        old = getattr(element, self.field.name)
        if self.inner is None:
            return self.changed(self.field, old, steps)
        return old.replace(**{self.inner.name: self.changed(self.inner, getattr(old, self.inner.name), steps)})

    def changed(self, field: Field, old: Any, steps: float) -> Any:
        """The same for the value of one field."""
        new = field.nudge(old, steps)
        return new if self.colour is None else (*old[: self.colour], new[self.colour], *old[self.colour + 1 :])


def values(element: Element) -> tuple[Value, ...]:
    """All of them, the components of colours behind everything else."""
    whole = [value for field in fields_of(type(element)) for value in within(field, getattr(element, field.name))]
    colours = [value for value in whole if isinstance(value.inner or value.field, Colour)]
    return (*whole, *(value._replace(colour=part) for value in colours for part in range(3)))


def within(field: Field, value: Any) -> Iterator[Value]:
    """Those of a field of an element; none where it is absent or names a file."""
    if isinstance(value, Record):
        start = 0
        for inner in fields_of(type(value)):
            if grows(inner):
                yield Value(field, inner, start=start)
            start += inner.width
    elif grows(field) and value is not None and not isinstance(value, str):
        yield Value(field)


def grows(field: Field) -> bool:
    """Whether key presses change values of the field."""
    return type(field).nudge is not Field.nudge
