"""Round edited numbers as a person would write them: 0.3 instead of 0.30000000000000004."""

from __future__ import annotations

from math import floor, hypot, log10
from typing import Any, TypeVar

from minirt.element import Record, fields_of
from minirt.fields import Angle, Direction, Factor, Field, Length, Point, Real, Triple, neat

POINT_DECIMALS = 5  # decimals that are kept, counted from the leading digit of a step of movement
LENGTH_DIGITS = 5  # significant digits of a length that are kept
REAL_DECIMALS = 3  # decimals of any other number that are kept, counted likewise from its own step
ANGLE_DECIMALS = 6  # decimals of degrees that are kept of a turn
ANGLE_NOISE = 5e-6  # degrees: a turn this close to thousandths of a degree is rounded to them
NOISE = 1e-7  # component of a direction that is what rounding has left of 0: no picture shows it
SLACK = 1 + 1e-9  # allows for the rounding of a power of ten

RecordType = TypeVar("RecordType", bound=Record)


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
    if isinstance(field, Real):
        places = leading_decimal(field.step) + REAL_DECIMALS
        return round_angle(after) if isinstance(field, Angle) else round(after, places)
    return after


def neat_direction(direction: Triple, keep_heading: bool) -> Triple:
    """Round a direction to nine digits, and components that are only rounding to 0.

    Both horizontal components of a view straight up or down are the heading of a camera, if it is to be kept.
    """
    is_vertical = hypot(direction[0], direction[2]) < NOISE
    x, y, z = (part if abs(part) >= NOISE else 0.0 for part in direction)
    return neat((direction[0], y, direction[2]) if is_vertical and keep_heading else (x, y, z))


def round_angle(degrees: float) -> float:
    """Round an angle, to thousandths of a degree if it is that within rounding."""
    short = round(degrees, 3)
    return short if abs(short - degrees) <= ANGLE_NOISE else round(degrees, ANGLE_DECIMALS)
