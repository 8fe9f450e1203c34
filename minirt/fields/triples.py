"""Fields of three numbers: points, directions, colours."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from minirt.errors import FieldError, quoted
from minirt.fields.field import Field, Repair
from minirt.fields.numerals import PLAIN, number, numbers, spelled, whole, wholes
from minirt.fields.scalars import FARTHEST, LEAST_LENGTH, clamp
from minirt.records import record

Triple = tuple[float, float, float]

SLACK = 1e-3  # by which the length of a direction may differ from 1 without a notice


@record(kw_only=True)
class Three(Field):
    """Three components with commas between them, called `names` in messages."""

    width = 3
    plain = ",".join([PLAIN] * width)

    names: str = "x,y,z"

    def component(self, text: str) -> float:
        return number(text)

    def parse(self, text: str) -> Triple:
        parts = text.split(",")
        if len(parts) != 3:
            extra = 3 if len(parts) > 3 else None
            raise FieldError(f"must be {self.names}, three numbers with commas between them, got {quoted(text)}", extra)
        part = 0
        try:
            x = self.component(parts[0])
            part = 1
            y = self.component(parts[1])
            part = 2
            return x, y, self.component(parts[2])
        except FieldError as error:
            raise FieldError(f"{self.names[2 * part]} {error}", part) from None

    def parse_all(self, texts: Sequence[str]) -> Sequence[Triple]:
        components = self.components(",".join(texts).split(","))
        return list(zip(components[::3], components[1::3], components[2::3], strict=True))

    def check_all(self, values: Sequence[Triple]) -> Sequence[Triple] | None:
        columns = list(zip(*values, strict=True))
        self.check(tuple(map(min, columns)))  # if the least and the greatest components are in range, all are
        self.check(tuple(map(max, columns)))
        return values

    def components(self, texts: Sequence[str]) -> Sequence[float]:
        """`component` of many texts at once; ValueError if one is wrong."""
        return numbers(texts)

    def format(self, value: Triple) -> str:
        return ",".join(map(spelled, value))

    def within(self, value: Triple, low: float, high: float) -> None:
        """Raise FieldError unless `value` is three numbers in [low, high]."""
        try:
            x, y, z = value
            if low <= x <= high and low <= y <= high and low <= z <= high:
                return
        except (TypeError, ValueError):
            raise FieldError(f"must be {self.names}, three numbers, got {value!r}") from None
        part = next(part for part, component in enumerate(value) if not low <= component <= high)
        raise FieldError(f"{self.names[2 * part]} must be in {self.range}, got {spelled(value[part])}", part)

    def repair(self, text: str) -> Repair | None:
        head, _, tail = text.rpartition(",")
        if text.count(",") != 3 or not reads(number, tail):
            return None
        return Repair(head, "drops the fourth component")


@record(kw_only=True)
class Point(Three):
    """A point in the scene."""

    unit: str = "scene unit"

    def check(self, value: Triple) -> Triple:
        self.within(value, -FARTHEST, FARTHEST)
        x, y, z = value
        return float(x), float(y), float(z)

    @property
    def notation(self) -> str:
        return "x,y,z"

    @property
    def range(self) -> str:
        return f"[-{FARTHEST:g}, {FARTHEST:g}]"


@record(kw_only=True)
class Lengths(Three):
    """Three sizes greater than 0; a key press multiplies all of them by `step`."""

    unit: str = "scene unit"
    step: float = 1.05

    def check(self, value: Triple) -> Triple:
        self.within(value, -FARTHEST, FARTHEST)
        part = next((part for part, size in enumerate(value) if not size > 0), None)
        if part is not None:
            raise FieldError(f"{self.names[2 * part]} must be > 0, got {spelled(value[part])}", part)
        x, y, z = value
        return float(x), float(y), float(z)

    def nudge(self, value: Triple, steps: float) -> Triple:
        factor = self.step ** clamp(steps, -10_000, 10_000)
        least, greatest = min(value), max(value)
        factor = clamp(factor, min(1.0, LEAST_LENGTH / least), max(1.0, FARTHEST / greatest))
        x, y, z = (min(size * factor, FARTHEST) for size in value)
        return x, y, z

    @property
    def notation(self) -> str:
        return self.names

    @property
    def range(self) -> str:
        return "> 0"


@record(kw_only=True)
class Direction(Three):
    """A direction with components in [-1, 1]; kept at unit length."""

    instead: Triple = (0.0, 1.0, 0.0)  # the direction that a lenient reader takes for 0,0,0
    may_be_zero: bool = False  # whether every reader takes it, as in the example that the subject prints

    def check(self, value: Triple) -> Triple:
        self.within(value, -1.0, 1.0)
        if not any(value):
            raise FieldError("must not be 0,0,0: it points nowhere")
        return unit(value)

    def check_all(self, values: Sequence[Triple]) -> Sequence[Triple] | None:
        return None if any(map(self.remark, values)) else list(map(self.check, values))

    def remark(self, value: Triple) -> str:
        length = math.hypot(*value)
        return f"has length {length:.4g}, and is scaled to 1" if abs(length - 1) > SLACK else ""

    def repair(self, text: str) -> Repair | None:
        if reads(self.parse, text):
            instead = self.format(self.instead)
            return None if any(self.parse(text)) else Repair(instead, f"takes {instead}", self.may_be_zero)
        repair = super().repair(text)  # a fourth component of 0 makes a direction in homogeneous coordinates
        return repair and repair._replace(certain=number(text.rpartition(",")[2]) == 0)

    @property
    def notation(self) -> str:
        return ",".join(self.name[:1] + axis for axis in "xyz")

    @property
    def range(self) -> str:
        return "[-1, 1]"


@record(kw_only=True)
class Colour(Three):
    """Red, green and blue, whole numbers from 0 to 255; a key press changes all three."""

    names: str = "R,G,B"
    step: float = 8.0
    initial: Any = (200, 200, 200)

    def component(self, text: str) -> int:
        return whole(text)

    def components(self, texts: Sequence[str]) -> Sequence[int]:
        return wholes(texts)

    def format(self, value: Triple) -> str:
        return ",".join(str(int(component)) for component in value)

    def check(self, value: Triple) -> tuple[int, int, int]:
        self.within(value, 0, 255)
        for part, component in enumerate(value):
            if component != int(component):
                raise FieldError(f"{'RGB'[part]} must be a whole number, got {component}", part)
        red, green, blue = value
        return int(red), int(green), int(blue)

    def repair(self, text: str) -> Repair | None:
        parts = text.split(",")
        if len(parts) != 3 or not all(reads(number, part) for part in parts):
            return None
        rounded = ",".join(str(math.floor(number(part) + 0.5)) for part in parts)
        return None if rounded == text else Repair(rounded, f"rounds it to {rounded}")

    def nudge(self, value: Triple, steps: float) -> tuple[int, int, int]:
        red, green, blue = (int(clamp(round(component + steps * self.step), 0, 255)) for component in value)
        return red, green, blue

    @property
    def notation(self) -> str:
        return self.names

    @property
    def range(self) -> str:
        return "[0, 255]"


def reads(parse: Callable[[str], Any], text: str) -> bool:
    """Whether `parse` accepts `text`."""
    try:
        parse(text)
    except FieldError:
        return False
    return True


def unit(vector: Triple) -> Triple:
    """Scale `vector` to length 1, even if its squares would underflow or overflow.

    A vector of length 1 within rounding is returned unchanged, so that saving and loading change nothing, unless a
    component is beyond 1, which no file may have. The quotient below is off by at most 2u in length and `hypot` by 2u
    more (u = 2^-53), so that scaling once is enough.
    """
    x, y, z = vector
    largest = max(abs(x), abs(y), abs(z))
    if largest <= 1.0 and abs(math.hypot(x, y, z) - 1.0) <= 4 * 2.0**-53:
        return float(x), float(y), float(z)
    x, y, z = x / largest, y / largest, z / largest
    length = math.hypot(x, y, z)
    return x / length, y / length, z / length
