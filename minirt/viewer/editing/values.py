"""Values of an element that keys increase and decrease: numbers, also of attributes, colours and their channels.

For a picture or mesh file, the next value is the next file beside the scene.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from minirt.element import Element, Record, fields_of
from minirt.fields import Angle, Choice, Colour, Field, MeshField, MeshFile, Picture
from minirt.viewer.editing.orientation import shows_roll

CHANNELS = "red", "green", "blue"

NextFile = Callable[[Any, float], Any]  # (file, steps) -> the picture or mesh file that many steps further


class Value(NamedTuple):
    """A field of an element, a field of a record that is the value of such a field, or a channel of either."""

    field: Field  # of the element
    inner: Field | None = None  # of the record
    channel: int | None = None  # 0, 1, 2: red, green, blue
    start: int = 0  # components of the record before the inner field

    @property
    def name(self) -> str:
        """Name that is shown to the user."""
        title = f"{self.field.title} {self.inner.title}" if self.inner else self.field.title
        return title if self.channel is None else f"{title}: {CHANNELS[self.channel]}"

    @property
    def range(self) -> str:
        """Range of the value in words."""
        return (self.inner or self.field).range

    @property
    def part(self) -> int | None:
        """Index of the component of the field, from 0; None for the whole field."""
        return None if self.inner is None and self.channel is None else self.start + (self.channel or 0)

    def stepped(self, element: Element, steps: float, next_file: NextFile) -> Any:
        """The field's value after a number of steps."""
        old = self.get(element)
        field = self.inner or self.field
        is_file = isinstance(old, str | MeshFile) and not isinstance(field, Choice)
        new = next_file(old, steps) if is_file else field.nudge(old, steps)
        return self.replaced(element, new)

    def replaced(self, element: Element, new: Any) -> Any:
        """The field's value with another current value; of a colour's channel, only that channel changes."""
        if self.channel is not None:
            old = self.get(element)
            new = (*old[: self.channel], new[self.channel], *old[self.channel + 1 :])
        return getattr(element, self.field.name).replace(**{self.inner.name: new}) if self.inner else new

    def get(self, element: Element) -> Any:
        """The current value; for a channel, that of the whole colour."""
        value = getattr(element, self.field.name)
        return getattr(value, self.inner.name) if self.inner else value


def values(element: Element) -> tuple[Value, ...]:
    """All values of an element; channels of colours come last."""
    unsplit = [
        value
        for field in fields_of(type(element))
        if not isinstance(field, Angle) or shows_roll(element)
        for value in values_of_field(field, getattr(element, field.name))
    ]
    unsplit.sort(key=lambda value: isinstance(value.field, MeshField))  # the size of a mesh comes before its file
    fields = ((value, value.inner or value.field) for value in unsplit)
    colours = [
        value for value, field in fields if isinstance(field, Colour) and not isinstance(value.get(element), str)
    ]
    return (*unsplit, *(value._replace(channel=channel) for value in colours for channel in range(3)))


def values_of_field(field: Field, value: Any) -> Iterator[Value]:
    """Yield the values of a field of an element; none if the field is absent."""
    if isinstance(value, Record):
        start = 0
        for inner in fields_of(type(value)):
            if is_editable(inner):
                yield Value(field, inner, start=start)
            start += inner.width
    elif is_editable(field) and value is not None:
        yield Value(field)


def is_editable(field: Field) -> bool:
    """Whether keys can change the value of the field."""
    return type(field).nudge is not Field.nudge or isinstance(field, Picture | MeshField)
