"""Base of materials with several values: the record of the values, and the field of a line that holds them."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any, ClassVar

from minirt.element import Record, fields_of
from minirt.errors import FieldError, quoted
from minirt.fields import Field, PictureFile, Real
from minirt.records import record

Share = partial(Real, unit="ratio", low=0.0, high=1.0, step=0.05, placeholder="share")


@record()
class Material(Record):
    """Values of one material, and the feature of the kernel that draws it."""

    feature: ClassVar[str]  # a key of `minirt.rendering.packing.features.FEATURES`
    needs: ClassVar[tuple[str, ...]] = ()  # fields of `Attributes`; without any of them it has no effect
    in_albedo: ClassVar[bool] = False  # whether it changes the colour of a surface under white light

    def rows(self, shape: Any, reader: Any) -> dict[str, Any]:
        """The rows of a shape with this material in the arrays of the kernel, by their names.

        `reader` has the scene's way to read colours and pictures: `minirt.rendering.packing.materials.Reader`.
        """
        return {}

    def has_effect(self) -> bool:
        """Whether the picture shows it: a material without effect, such as a share of 0, costs no feature."""
        return bool(getattr(self, "share", True))

    def features(self) -> tuple[str, ...]:
        """The features that the kernel needs to draw it, the main one first; none if it has no effect."""
        return (self.feature,) if self.has_effect() else ()


@record(kw_only=True)
class Compound(Field):
    """The field of a material with several values, separated by commas: `specular:0.5,30,blinn`.

    The values are in the order of its fields; the last ones may be left out where they have a default.

    A program may give a number in place of a material whose other values may be left out: it is the first value.
    """

    record: type[Material]

    @property
    def sort_of_value(self) -> str:  # type: ignore[override]
        """The kinds of value that a program may give, for messages."""
        return f"{'a number or ' if self.is_one_number else ''}a minirt.{self.record.__name__}"

    @property
    def is_one_number(self) -> bool:
        """Whether the values behind the first may be left out."""
        return not any(field.required for field in fields_of(self.record)[1:])

    def parse(self, text: str) -> Material:
        """Return the material with the values of a text; FieldError has the index of the word that is wrong."""
        words, start, values = text.split(","), 0, {}
        for field in fields_of(self.record):
            own_words = words[start : start + field.width]
            if not own_words and not field.required:
                break
            if len(own_words) < field.width:
                raise FieldError(f"must be {self.pattern}, got {quoted(text)}")
            try:
                values[field.name] = field.check(field.parse(",".join(own_words)))
            except FieldError as error:
                raise FieldError(f"{field.title} {error}", start + (error.part or 0)) from None
            start += field.width
        if start < len(words):
            raise FieldError(f"must be {self.pattern}, got {quoted(text)}", start)
        return self.record(**values)

    def format(self, value: Material) -> str:
        spelled: list[str] = []
        for field in reversed(fields_of(self.record)):
            own = getattr(value, field.name)
            if spelled or field.required or own != field.default:
                spelled.insert(0, field.format(own))
        return ",".join(spelled)

    def check(self, value: Any) -> Material:
        if isinstance(value, float | int) and self.is_one_number:
            try:
                return self.record(value)
            except ValueError as error:
                raise FieldError(str(error).removeprefix(f"{self.record.title} ")) from None
        if not isinstance(value, self.record):
            raise FieldError(f"must be a {self.record.__name__}, got {value!r}")
        return value

    def pictures(self, value: Material) -> Iterator[PictureFile]:
        start = 0
        for field in fields_of(self.record):
            for each in field.pictures(getattr(value, field.name)):
                yield each._replace(part=start)
            start += field.width

    @property
    def facts(self) -> type[Material]:
        return self.record

    def features_of(self, value: Material) -> tuple[str, ...]:
        return value.features()

    def rows(self, value: Material, shape: Any, reader: Any) -> dict[str, Any]:
        return value.rows(shape, reader)

    @property
    def example(self) -> str:
        parts = [field.example for field in fields_of(self.record) if field.required]
        return ",".join(parts) if all(parts) else ""

    @property
    def pattern(self) -> str:
        """The format of the value: `share,exponent[,blinn]`."""
        fields = fields_of(self.record)
        first, *rest = (field.placeholder or field.notation for field in fields)
        optional = [not field.required for field in fields[1:]]
        parts = "".join(f"[,{each}" if last else f",{each}" for each, last in zip(rest, optional, strict=True))
        return first + parts + "]" * sum(optional)

    @property
    def notation(self) -> str:
        return f"{self.prefix}{self.pattern}"
