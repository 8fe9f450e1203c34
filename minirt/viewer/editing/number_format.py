"""Numbers as a person would write them: 0.3 and not 0.30000000000000004."""

from __future__ import annotations

from math import floor, log10
from typing import Any, TypeVar

from minirt.element import Record, fields_of
from minirt.fields import Factor, Field, Length, Point, Real

PLACES = 5  # decimals of a step of movement that are kept
DIGITS = 5  # of a length that are kept
TENTHS = 3  # decimals of a step of any other number that are kept
SLACK = 1 + 1e-9  # what rounding may have done to a power of ten

Kind = TypeVar("Kind", bound=Record)


def decimals(number: float) -> int:
    """The place of the first digit of `number` behind the point; 0 or less in front of it."""
    return -floor(log10(number * SLACK))


def nice(length: float) -> float:
    """The greatest of ..., 0.1, 0.2, 0.5, 1, 2, 5, 10, ... that is not above `length`."""
    places = decimals(length)
    steps = [round(digit * 10.0**-places, places) for digit in (1, 2, 5)]
    return max(step for step in steps if step <= length * SLACK)


def neat(old: Record, new: Kind, stride: float) -> Kind:
    """`new` with round numbers where it differs from `old`: a tiny part of a step is left out, too little to be seen.

    `stride` is a step of a movement, in scene units.
    """
    changes = {}
    for field in fields_of(type(new)):
        before, after = getattr(old, field.name), getattr(new, field.name)
        if after != before:
            changes[field.name] = rounded(field, before, after, stride)
    return new.replace(**changes)


def round_length(length: float) -> float:
    """To as many digits as are kept of a length."""
    return round(length, decimals(length) + DIGITS - 1)


def rounded(field: Field, before: Any, after: Any, stride: float) -> Any:
    """The value of a field that was edited."""
    if isinstance(before, Record) and isinstance(after, Record):
        return neat(before, after, stride)
    if isinstance(field, (Factor, Length)):
        return round_length(after)
    if isinstance(field, Point):
        places = decimals(stride) + PLACES
        return tuple(b if a == b else round(b, places) for a, b in zip(before, after, strict=True))
    if isinstance(field, Real):
        return round(after, decimals(field.step) + TENTHS)
    return after
