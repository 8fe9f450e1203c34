"""Fields of one number: ratios, angles, lengths, sizes in pixels; and flags, which are one word."""

from __future__ import annotations

from collections.abc import Sequence
from math import copysign

from minirt.errors import FieldError, quoted
from minirt.fields.field import Field
from minirt.fields.numerals import PLAIN, number, numbers, spelled, whole, wholes
from minirt.records import record

FARTHEST = 1e15  # scene units; beyond it neighbouring float64 numbers are an eighth of a unit apart
LEAST_LENGTH = 1e-9  # scene units; editing never makes a length smaller


def clamp(value: float, low: float, high: float) -> float:
    """`value`, or the nearest end of [low, high] if it lies outside."""
    return min(max(value, low), high)


@record(kw_only=True)
class Scalar(Field):
    """One number in an interval."""

    plain = PLAIN

    def parse_all(self, texts: Sequence[str]) -> Sequence[float]:
        return numbers(texts)

    def check_all(self, values: Sequence[float]) -> Sequence[float] | None:
        least, greatest = min(values), max(values)  # if they are in range, all are
        return None if any(self.remark(self.check(end)) for end in (least, greatest)) else values


@record(kw_only=True)
class Real(Scalar):
    """A number in [low, high]."""

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

    def nudge(self, value: float, steps: float) -> float:
        return clamp(value + steps * self.step, self.low, self.high)

    @property
    def range(self) -> str:
        return f"[{spelled(self.low)}, {spelled(self.high)}]"


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

    def parse(self, text: str) -> float:
        return number(text)

    def format(self, value: float) -> str:
        return spelled(value)

    def check(self, value: float) -> float:
        if not value > 0:
            raise FieldError(f"must be > 0, got {spelled(value)}")
        if not value <= FARTHEST:
            raise FieldError(f"must be at most {FARTHEST:g}, got {spelled(value)}")
        return float(value)

    def nudge(self, value: float, steps: float) -> float:
        least = min(value, LEAST_LENGTH)
        factor = self.step ** clamp(steps, -10_000, 10_000)
        return clamp(value * factor, least, FARTHEST)

    @property
    def range(self) -> str:
        return "> 0"


@record(kw_only=True)
class Factor(Real):
    """A number above 0 in [low, high]; a key press multiplies it by `step`."""

    low: float = 1.0
    step: float = 1.1

    def nudge(self, value: float, steps: float) -> float:
        return clamp(value * self.step ** clamp(steps, -1000, 1000), self.low, self.high)


@record(kw_only=True)
class Whole(Scalar):
    """A whole number in [low, high]."""

    low: int
    high: int

    def parse(self, text: str) -> int:
        return whole(text)

    def parse_all(self, texts: Sequence[str]) -> Sequence[int]:
        return wholes(texts)

    def check(self, value: int) -> int:
        if not (self.low <= value <= self.high and value == int(value)):
            raise FieldError(f"must be a whole number in {self.range}, got {value}")
        return int(value)

    @property
    def range(self) -> str:
        return f"[{self.low}, {self.high}]"


@record(kw_only=True)
class Count(Whole):
    """A whole number in [low, high] that a key press changes by one or more."""

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

    def nudge(self, value: bool, steps: float) -> bool:
        return steps > 0
