"""Fields of three numbers: points, sizes, colours; and a colour that may be a picture instead."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from typing import Any, ClassVar

from minirt.errors import FieldError, quoted
from minirt.fields.field import Field, PictureFile, file_name, in_quotes, unquoted
from minirt.fields.scalars import Length, Scalar, Whole, clamp, scaled
from minirt.records import record

Triple = tuple[float, float, float]


@record(kw_only=True)
class Three(Field):
    """Three components with commas between them, called `names` in messages, each a number of its own."""

    width = 3
    number: ClassVar[type[float]] = float
    component: ClassVar[Scalar] = Scalar(doc="a component")

    names: str = "x,y,z"

    def parse(self, text: str) -> Triple:
        parts = text.split(",")
        if len(parts) != 3:
            extra = 3 if len(parts) > 3 else None
            raise FieldError(f"must be {self.names}, three numbers with commas between them, got {quoted(text)}", extra)
        return self.of_each(self.component.parse, parts, every=False)

    def of_each(self, function: Callable[[Any], Any], parts: Sequence[Any], every: bool = True) -> Triple:
        """The results of a function of each component; FieldError, which names every wrong component, or the first."""
        results, errors = [], []
        for part, component in enumerate(parts):
            try:
                results.append(function(component))
            except FieldError as error:
                errors.append(FieldError(f"{self.names[2 * part]} {error}", part))
        if errors:
            errors[0].further = errors[1:] if every else ()
            raise errors[0]
        x, y, z = results
        return x, y, z

    def check(self, value: Triple) -> Triple:
        with suppress(TypeError):
            if len(value) == 3:
                return self.of_each(self.component.check, value)
        raise FieldError(f"must be {self.names}, three numbers, got {value!r}")

    def fits(self, numbers: Any) -> Any:
        return self.component.fits(numbers)

    def values(self, numbers: Any) -> list[Triple]:
        return list(map(tuple, numbers.astype(self.number).tolist()))

    def format(self, value: Triple) -> str:
        return ",".join(map(self.component.format, value))

    @property
    def notation(self) -> str:
        return self.names

    @property
    def range(self) -> str:
        return self.component.range


@record(kw_only=True)
class Point(Three):
    """A point in the scene."""

    unit: str = "scene unit"


@record(kw_only=True)
class Lengths(Three):
    """Three sizes greater than 0; a key press multiplies all of them by `step`."""

    component = Length(doc="a size")

    unit: str = "scene unit"
    step: float = 1.05

    def nudge(self, value: Triple, steps: float) -> Triple:
        x, y, z = scaled(value, self.step ** clamp(steps, -10_000, 10_000))
        return x, y, z


@record(kw_only=True)
class Colour(Three):
    """Red, green and blue, whole numbers from 0 to 255; a key press changes all three."""

    number, component = int, Whole(doc="a channel", low=0, high=255)

    names: str = "R,G,B"
    step: float = 8.0
    initial: Any = (200, 200, 200)

    def nudge(self, value: Triple, steps: float) -> tuple[int, int, int]:
        red, green, blue = (int(clamp(round(component + steps * self.step), 0, 255)) for component in value)
        return red, green, blue


@record(kw_only=True)
class Paint(Colour):
    """A colour or a picture file; a word with a comma is a colour."""

    def parse(self, text: str) -> Triple | str:  # type: ignore[override]
        return super().parse(text) if "," in text else unquoted(text)

    def format(self, value: Triple | str) -> str:
        return in_quotes(value) if isinstance(value, str) else super().format(value)

    def check(self, value: Triple | str) -> Triple | str:  # type: ignore[override]
        return file_name(value, ",") if isinstance(value, str) else super().check(value)

    def nudge(self, value: Triple | str, steps: float) -> Triple | str:  # type: ignore[override]
        return value if isinstance(value, str) else super().nudge(value, steps)

    def pictures(self, value: Triple | str) -> Iterator[PictureFile]:
        if isinstance(value, str):
            yield PictureFile(value, sky=True)

    @property
    def notation(self) -> str:
        return "R,G,B or file"
