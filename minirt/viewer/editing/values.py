"""Values of an element that keys increase and decrease: numbers, also of attributes, colours and their channels.

For a picture or mesh file, the next value is the next file beside the scene. Edited numbers are rounded as a person
would write them: 0.3 instead of 0.30000000000000004.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import floor, hypot, log10
from typing import Any, NamedTuple, TypeVar

from minirt.element import Element, Record, fields_of
from minirt.fields import Angle, Colour, Direction, Factor, Field, Length, MeshField, Picture, Point, Real, Triple, neat
from minirt.shapes.shape import Oriented

CHANNELS = "red", "green", "blue"

NextFile = Callable[[Any, float], Any]  # (file, steps) -> the picture or mesh file that many steps further
POINT_DECIMALS = 5  # decimals that are kept, counted from the leading digit of a step of movement
LENGTH_DIGITS = 5  # significant digits of a length that are kept
REAL_DECIMALS = 3  # decimals of any other number that are kept, counted likewise from its own step
ANGLE_DECIMALS = 6  # decimals of degrees that are kept of a turn
ANGLE_NOISE = 5e-6  # degrees: a turn this close to thousandths of a degree is rounded to them
NOISE = 1e-7  # component of a direction that is what rounding has left of 0: no picture shows it
SLACK = 1 + 1e-9  # allows for the rounding of a power of ten
RecordType = TypeVar("RecordType", bound=Record)


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
        is_file = isinstance(field, MeshField) or any(field.pictures(old))
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
    colours = [each for each, field in fields if isinstance(field, Colour) and not isinstance(each.get(element), str)]
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


def shows_roll(element: Element) -> bool:
    """Whether a turn of an element about its own axis is worth a word in the file."""
    return isinstance(element, Oriented) and (element.shows_roll or element.roll != 0.0)


def leading_decimal(number: float) -> int:
    """Decimal place of the leading digit of `number`: 1 for 0.3, 0 for 3, -1 for 30."""
    return -floor(log10(number * SLACK))


def nice_number(length: float) -> float:
    """Nice number (Heckbert 1990): the greatest of ..., 0.1, 0.2, 0.5, 1, 2, 5, 10, ... that is not above `length`."""
    places = leading_decimal(length)
    steps = [round(digit * 10.0**-places, places) for digit in (1, 2, 5)]
    return max(step for step in steps if step <= length * SLACK)


def round_changes(old: Record, new: RecordType, stride: float) -> RecordType:
    """Round the numbers of `new` that differ from `old`, by an invisible fraction of a step.

    stride: a step of a movement in scene units.
    """
    changes = {}
    for field in fields_of(type(new)):
        before, after = getattr(old, field.name), getattr(new, field.name)
        if after != before:
            changes[field.name] = round_value(field, before, after, stride)
    return new.replace(**changes)


def round_length(length: float) -> float:
    """Round a length to LENGTH_DIGITS significant digits."""
    return round(length, leading_decimal(length) + LENGTH_DIGITS - 1)


def round_point(point: Triple, stride: float) -> Triple:
    """Round coordinates to as many decimals as a tenth of a step of movement has."""
    x, y, z = (round(part, leading_decimal(stride) + 1) + 0.0 for part in point)
    return x, y, z


def round_value(field: Field, before: Any, after: Any, stride: float) -> Any:
    """Round the edited value of a field."""
    if isinstance(before, Record) and isinstance(after, Record):
        return round_changes(before, after, stride)
    if isinstance(field, (Factor, Length)):
        return round_length(after)
    if isinstance(field, Point):
        places = leading_decimal(stride) + POINT_DECIMALS
        return tuple(b if a == b else round(b, places) for a, b in zip(before, after, strict=True))
    if isinstance(field, Direction):
        return neat_direction(after, keep_heading=True)
    if isinstance(field, Angle):
        short = round(after, 3)
        return short if abs(short - after) <= ANGLE_NOISE else round(after, ANGLE_DECIMALS)
    return round(after, leading_decimal(field.step) + REAL_DECIMALS) if isinstance(field, Real) else after


def neat_direction(direction: Triple, keep_heading: bool) -> Triple:
    """Round a direction to nine digits, and components that are only rounding to 0.

    Both horizontal components of a view straight up or down are the heading of a camera, if it is to be kept.
    """
    is_vertical = hypot(direction[0], direction[2]) < NOISE
    x, y, z = (part if abs(part) >= NOISE else 0.0 for part in direction)
    return neat((direction[0], y, direction[2]) if is_vertical and keep_heading else (x, y, z))
