"""Numbers in a scene file, in decimal and exact to the last bit of a float64; and the fields of one number or flag."""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Sequence
from math import copysign
from typing import Any, ClassVar

from minirt.errors import FieldError, quoted
from minirt.fields.field import Field
from minirt.records import record

NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
WHOLE = re.compile(r"[+-]?[0-9]+")
LONGEST = 300  # characters: many more than `repr` writes, few enough for a whole number to fit into a float64
FARTHEST = 1e15  # scene units; beyond it neighbouring float64 numbers are an eighth of a unit apart
SMALLEST = 1e-50  # of a length; formulas square squares of lengths, and of coordinates in lengths
LEAST_LENGTH = 1e-9  # scene units; editing never makes a length smaller


def number(text: str) -> float:
    """Parse a finite number; refuse nan, 1_000 and digits of other scripts, which `float` accepts."""
    if len(text) > LONGEST or not NUMBER.fullmatch(text):
        raise FieldError("must be a number, " + found(text))
    value = float(text)
    if not math.isfinite(value):
        raise FieldError(f"must be a number that a float64 can hold, got {quoted(text)}")
    return value + 0.0  # -0 becomes 0


def whole(text: str) -> int:
    """Parse a whole number."""
    if len(text) > LONGEST or not WHOLE.fullmatch(text):
        raise FieldError("must be a whole number, " + found(text))
    return int(text)


def found(text: str) -> str:
    """The part of a message that quotes a wrong number, with the reason if it cannot be seen."""
    if len(text) > LONGEST:
        return f"got {len(text)} characters: {quoted(text)}, which is too long"
    foreign = next((character for character in text if not character.isascii()), "")
    return f"got {quoted(text)}" + (f": {code_point_name(foreign)} is not ASCII" if foreign else "")


def code_point_name(character: str) -> str:
    """A character as its code point and Unicode name."""
    return f"U+{ord(character):04X} {unicodedata.name(character, '')}".rstrip()


def spelled(value: float) -> str:
    """Format a number as the shortest decimal that reads back as the same float64, without a trailing `.0`."""
    return repr(float(value) + 0.0).removesuffix(".0")


def clamp(value: float, low: float, high: float) -> float:
    """`value`, or the nearest end of [low, high] if it lies outside."""
    return min(max(value, low), high)


def clamp_length(length: float) -> float:
    """Clamp a length to what editing makes, from `LEAST_LENGTH` to `FARTHEST`."""
    return clamp(length, LEAST_LENGTH, FARTHEST)


def scaled(sizes: Sequence[float], factor: float) -> list[float]:
    """Multiply sizes by a factor, but no farther than one of them becomes `LEAST_LENGTH` or `FARTHEST`."""
    factor = clamp(factor, min(1.0, LEAST_LENGTH / min(sizes)), max(1.0, FARTHEST / max(sizes)))
    return [min(size * factor, FARTHEST) for size in sizes]


@record(kw_only=True)
class Scalar(Field):
    """A number in [low, high]."""

    number: ClassVar[type[float]] = float
    sort_of_value: ClassVar[str] = "a number"

    low: float = -FARTHEST
    high: float = FARTHEST
    ends: str = ""  # notice about the values `low` and `high` themselves, if there is one

    def parse(self, text: str) -> float:
        return number(text)

    def format(self, value: float) -> str:
        return spelled(value)

    def check(self, value: float) -> float:
        if not self.low <= value <= self.high:
            raise FieldError(f"must be in {self.range}, got {spelled(value)}")
        return float(value)

    def remark(self, value: float) -> str:
        return f"{spelled(value)} {self.ends}" if self.ends and value in (self.low, self.high) else ""

    def fits(self, numbers: Any) -> Any:
        """Return (n,) whether each row of numbers, (n, width), is in range and needs no remark."""
        are_inside = (self.low <= numbers) & (numbers <= self.high)
        if self.ends:
            are_inside &= (numbers != self.low) & (numbers != self.high)
        return are_inside.all(axis=1)

    def values(self, numbers: Any) -> list[Any]:
        """The values of rows of numbers that fit."""
        values: list[Any] = numbers[:, 0].astype(self.number).tolist()
        return values

    @property
    def range(self) -> str:
        return f"[{self.low:.9g}, {self.high:.9g}]"


@record(kw_only=True)
class Real(Scalar):
    """A number in [low, high], to which a key press adds `step`."""

    def nudge(self, value: float, steps: float) -> float:
        return clamp(value + steps * self.step, self.low, self.high)


@record(kw_only=True)
class Angle(Real):
    """A turn of an element about its own axis."""

    unit: str = "degree"
    low: float = -360.0
    high: float = 360.0


@record(kw_only=True)
class Length(Scalar):
    """A size greater than 0; a key press multiplies it by `step`."""

    unit: str = "scene unit"
    step: float = 1.05
    low: float = SMALLEST

    def check(self, value: float) -> float:
        if not value > 0:
            raise FieldError(f"must be > 0, got {spelled(value)}")
        return super().check(value)

    def nudge(self, value: float, steps: float) -> float:
        return scaled([value], self.step ** clamp(steps, -10_000, 10_000))[0]


@record(kw_only=True)
class Factor(Real):
    """A number above 0 in [low, high]; a key press multiplies it by `step`."""

    low: float = 1.0
    step: float = 1.1

    def nudge(self, value: float, steps: float) -> float:
        return clamp(value * self.step ** clamp(steps, -1000, 1000), self.low, self.high)


@record(kw_only=True)
class Whole(Scalar):
    """A whole number in [low, high], which a key press changes by one or more."""

    number = int

    def parse(self, text: str) -> int:
        return whole(text)

    def check(self, value: float) -> int:
        super().check(value)
        if value != int(value):
            raise FieldError(f"must be a whole number, got {value}")
        return int(value)

    def nudge(self, value: int, steps: float) -> int:
        return int(clamp(value + round(copysign(max(abs(steps), 1.0), steps)), self.low, self.high))


@record(kw_only=True)
class Flag(Field):
    """A flag: true if the word that is its name is there."""

    default: bool = False

    def parse(self, text: str) -> bool:
        if text != self.name:
            raise FieldError(f"must be the word '{self.name}' or be left out, got {quoted(text)}")
        return True

    def format(self, value: bool) -> str:
        return self.name

    def check(self, value: bool) -> bool:
        return bool(value)

    def of_flag(self, value: bool) -> bool:
        return value

    def nudge(self, value: bool, steps: float) -> bool:
        return steps > 0
