"""Fields of three numbers: points, sizes, colours; and a colour that may be a picture instead."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from minirt.errors import FieldError, quoted
from minirt.fields.field import Field, PictureFile, Repair, file_name
from minirt.fields.scalars import FARTHEST, LEAST_LENGTH, PLAIN, clamp, number, numbers, spelled, whole, wholes
from minirt.records import record

Triple = tuple[float, float, float]


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

    def check(self, value: Triple) -> Triple:
        self.within(value, -FARTHEST, FARTHEST)
        x, y, z = value
        return float(x), float(y), float(z)

    def repair(self, text: str) -> Repair | None:
        head, _, tail = text.rpartition(",")
        if text.count(",") != 3 or not reads(number, tail):
            return None
        return Repair(head, "drops the fourth component")

    @property
    def notation(self) -> str:
        return self.names

    @property
    def range(self) -> str:
        return f"[-{FARTHEST:g}, {FARTHEST:g}]"


@record(kw_only=True)
class Point(Three):
    """A point in the scene."""

    unit: str = "scene unit"


@record(kw_only=True)
class Lengths(Three):
    """Three sizes greater than 0; a key press multiplies all of them by `step`."""

    unit: str = "scene unit"
    step: float = 1.05

    def check(self, value: Triple) -> Triple:
        checked = super().check(value)
        part = next((part for part, size in enumerate(value) if not size > 0), None)
        if part is not None:
            raise FieldError(f"{self.names[2 * part]} must be > 0, got {spelled(value[part])}", part)
        return checked

    def nudge(self, value: Triple, steps: float) -> Triple:
        factor = self.step ** clamp(steps, -10_000, 10_000)
        least, greatest = min(value), max(value)
        factor = clamp(factor, min(1.0, LEAST_LENGTH / least), max(1.0, FARTHEST / greatest))
        x, y, z = (min(size * factor, FARTHEST) for size in value)
        return x, y, z

    @property
    def range(self) -> str:
        return "> 0"


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
    def range(self) -> str:
        return "[0, 255]"


def reads(parse: Callable[[str], Any], text: str) -> bool:
    """Whether `parse` accepts `text`."""
    try:
        parse(text)
    except FieldError:
        return False
    return True


@record(kw_only=True)
class Paint(Colour):
    """A colour or a picture file; a word with a comma is a colour."""

    def parse(self, text: str) -> Triple | str:  # type: ignore[override]
        return super().parse(text) if "," in text else file_name(text, ",")

    def format(self, value: Triple | str) -> str:
        return value if isinstance(value, str) else super().format(value)

    def check(self, value: Triple | str) -> Triple | str:  # type: ignore[override]
        return file_name(value, ",") if isinstance(value, str) else super().check(value)

    def repair(self, text: str) -> Repair | None:
        return super().repair(text) if "," in text else None

    def nudge(self, value: Triple | str, steps: float) -> Triple | str:  # type: ignore[override]
        return value if isinstance(value, str) else super().nudge(value, steps)

    def pictures(self, value: Triple | str) -> Iterator[PictureFile]:
        if isinstance(value, str):
            yield PictureFile(value, sky=True)

    @property
    def notation(self) -> str:
        return "R,G,B or file"
