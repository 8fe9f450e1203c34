"""Values of an element that keys and the panel change: numbers, also of attributes, colours, and parts of triples.

Parts are the channels of a colour, the sizes of a box, coordinates, and the angles of a direction. For a picture or
mesh file, the next value is the next file beside the scene. Edited numbers are rounded as a person would write them:
0.3 instead of 0.30000000000000004.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from math import asin, atan2, degrees, floor, hypot, log10
from typing import Any, NamedTuple, TypeVar

from minirt.element import Element, Record, fields_of
from minirt.fields import Angle, Colour, Direction, Field, Length, Lengths, MeshField, Point, Real, Three, Triple
from minirt.fields.directions import cos_and_sin, neat
from minirt.fields.scalars import FARTHEST, Factor, clamp
from minirt.scene import Scene
from minirt.shapes.shape import Oriented
from minirt.viewer.files import next_file

CHANNELS = "red", "green", "blue"
ANGLES = "heading", "elevation"  # of a direction, in degrees: from z towards x, and above the horizon
ANGLE_STEP, PART_STEP = 5.0, 0.05  # of an angle of a direction, in degrees, and of a component

POINT_DECIMALS = 5  # decimals that are kept, counted from the leading digit of a step of movement
LENGTH_DIGITS = 5  # significant digits of a length that are kept
REAL_DECIMALS = 3  # decimals of any other number that are kept, counted likewise from its own step
ANGLE_DECIMALS = 6  # decimals of degrees that are kept of a turn
SHORT_ANGLE_DECIMALS = 3  # decimals of degrees that are kept of a turn that is as close to them as ANGLE_NOISE
ANGLE_NOISE = 5e-6  # degrees
NOISE = 1e-7  # component of a direction that is what rounding has left of 0: no picture shows it
SLACK = 1 + 1e-9  # allows for the rounding of a power of ten
RecordType = TypeVar("RecordType", bound=Record)


class Value(NamedTuple):
    """A field of an element, a field of a record that is the value of such a field, or a part of either."""

    field: Field  # of the element
    inner: Field | None = None  # of the record
    channel: int | None = None  # index of the part in `part_names` of the field
    start: int = 0  # components of the record before the inner field

    @property
    def leaf(self) -> Field:
        """The field that spells the value."""
        return self.inner or self.field

    @property
    def name(self) -> str:
        """Name that is shown to the user."""
        title = f"{self.field.title} {self.inner.title}" if self.inner else self.field.title
        return title if self.channel is None else f"{title}: {part_names(self.leaf)[self.channel]}"

    @property
    def part(self) -> int | None:
        """Index of the component of the field, from 0; None for the whole field, and for an angle of a direction."""
        if (self.inner is None and self.channel is None) or (self.channel or 0) >= Three.width:
            return None
        return self.start + (self.channel or 0)

    def stepped(self, element: Element, steps: float, scene: Scene, stride: float) -> Any:
        """The value of the whole field after a number of steps, which may be negative or fractions.

        stride: a step of a movement in scene units. For a picture or mesh file, see `next_file`.
        """
        field, old = self.leaf, self.get(element)
        if isinstance(field, MeshField) or any(field.pictures(old)):
            return self.replaced(element, next_file(scene, old, steps))
        if self.channel is None or isinstance(field, Colour | Lengths):
            new = field.nudge(old, steps)
            return self.replaced(element, new if self.channel is None else new[self.channel])
        if self.channel >= Three.width:  # an angle: a heading goes round, an elevation stops at the vertical
            angle = self.current(element) + steps * ANGLE_STEP
            is_heading = self.channel == Three.width
            return self.replaced(element, (angle + 180) % 360 - 180 if is_heading else clamp(angle, -90.0, 90.0))
        step, end = (stride, FARTHEST) if isinstance(field, Point) else (PART_STEP, 1.0)
        return self.replaced(element, clamp(self.current(element) + steps * step, -end, end))

    def replaced(self, element: Element, new: Any) -> Any:
        """The field's value with another current value, not checked; ElementError for one of a record out of range."""
        if self.channel is not None:
            new = with_part(self.get(element), self.channel, new)
        return getattr(element, self.field.name).replace(**{self.inner.name: new}) if self.inner else new

    def get(self, element: Element) -> Any:
        """The current value; for a part, that of the whole triple."""
        value = getattr(element, self.field.name)
        return getattr(value, self.inner.name) if self.inner else value

    def current(self, element: Element) -> Any:
        """The current value; of a triple only the part, if this is one."""
        value = self.get(element)
        if self.channel is None:
            return value
        return (*value, *angles_of(value))[self.channel] if self.channel >= Three.width else value[self.channel]


def part_names(field: Field) -> tuple[str, ...]:
    """Names of the parts of a field that has three components, and of the angles of a direction."""
    if isinstance(field, Colour):
        return CHANNELS
    names = tuple(field.names.split(",")) if isinstance(field, Three) else ()
    return (*names, *ANGLES) if isinstance(field, Direction) else names


def angles_of(direction: Triple) -> tuple[float, float]:
    """Heading and elevation of a unit vector, in degrees; the heading of a vertical one is 0."""
    x, y, z = direction
    heading = degrees(atan2(x, z)) if x or z else 0.0
    return tuple(round(angle, ANGLE_DECIMALS) + 0.0 for angle in (heading, degrees(asin(clamp(y, -1, 1)))))  # type: ignore[return-value]


def with_part(triple: Triple, channel: int, new: Any) -> Triple:
    """A triple with another part: a component, or an angle of a direction."""
    if channel < Three.width:
        x, y, z = (new if part == channel else old for part, old in enumerate(triple))
        return x, y, z
    heading, elevation = (new if part == channel else old for part, old in enumerate(angles_of(triple), Three.width))
    (cosine, sine), (level, height) = cos_and_sin(heading), cos_and_sin(elevation)
    return level * sine, height, level * cosine


def position_value(element: Element) -> Value | None:
    """The first coordinate of an element's position; None if it has none."""
    return next((each for each in values(element) if isinstance(each.leaf, Point)), None)


def values(element: Element) -> tuple[Value, ...]:
    """All values of an element; parts of triples come last, positions and directions after the others."""
    every = [each for field in seen_fields(element) for each in values_of_field(field, getattr(element, field.name))]
    unsplit = [each for each in every if not isinstance(each.leaf, Point | Direction)]
    unsplit.sort(key=lambda value: isinstance(value.field, MeshField))  # the size of a mesh comes before its file
    sorts: tuple[type[Field], ...] = (Colour, Lengths, Point, Direction)
    triples = [each for each in every if not isinstance(each.get(element), str)]
    whole = (each for sort in sorts for each in triples if isinstance(each.leaf, sort))
    return (*unsplit, *(each._replace(channel=part) for each in whole for part in range(len(part_names(each.leaf)))))


def seen_fields(element: Element) -> Iterator[Field]:
    """Yield the fields of an element; those of a turn about its own axis only where that is seen."""
    for field in fields_of(type(element)):
        if not (isinstance(field, Angle | Direction) and field.keyed) or shows_roll(element):
            yield field


def values_of_field(field: Field, value: Any) -> Iterator[Value]:
    """Yield the values of a field of an element; none if the field is absent."""
    if isinstance(value, Record):
        start = 0
        for inner in fields_of(type(value)):
            yield Value(field, inner, start=start)
            start += inner.width
    elif value is not None:
        yield Value(field)


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
    """Round the edited value of a field, which was `before`, by an invisible fraction of what an edit changes.

    stride: a step of a movement in scene units. Components that are as they were, and values that are no real
    numbers, stay as they are.
    """
    if isinstance(before, Record) and isinstance(after, Record):
        return round_changes(before, after, stride)
    if isinstance(field, (Factor, Length)):
        return round_length(after)
    if isinstance(field, Point | Lengths):
        places = leading_decimal(stride) + POINT_DECIMALS
        rounded = round_length if isinstance(field, Lengths) else partial(round, ndigits=places)
        return tuple(b if a == b else rounded(b) for a, b in zip(before, after, strict=True))
    if isinstance(field, Direction):
        return neat_direction(after, keep_heading=True)
    if isinstance(field, Angle):
        short = round(after, SHORT_ANGLE_DECIMALS)
        return short if abs(short - after) <= ANGLE_NOISE else round(after, ANGLE_DECIMALS)
    return round(after, leading_decimal(field.step) + REAL_DECIMALS) if isinstance(field, Real) else after


def neat_direction(direction: Triple, keep_heading: bool) -> Triple:
    """Round a direction to nine digits, and components that are only rounding to 0.

    Both horizontal components of a view straight up or down are the heading of a camera, if it is to be kept.
    """
    is_vertical = hypot(direction[0], direction[2]) < NOISE
    x, y, z = (part if abs(part) >= NOISE else 0.0 for part in direction)
    return neat((direction[0], y, direction[2]) if is_vertical and keep_heading else (x, y, z))
