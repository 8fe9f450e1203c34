"""Fields that name picture files, by a path that begins at the folder of the scene file."""

from __future__ import annotations

from collections.abc import Iterator

from minirt.errors import FieldError
from minirt.fields.field import Field, PictureFile, Repair
from minirt.fields.triples import Colour, Triple
from minirt.records import record

FORBIDDEN = " \t\r\n\0#"  # a line is cut at blanks, and `#` begins a comment


def file_name(text: str, also: str = "", sort: str = "picture") -> str:
    """Check the name of a file: FieldError if it cannot stand in a line, or has one of the characters in `also`."""
    if not isinstance(text, str) or not text or any(character in text for character in FORBIDDEN + also):
        commas = ", commas" if "," in also else ""
        raise FieldError(f"must be the name of a {sort} file, without blanks{commas} and #, got {text!r}")
    return text


@record(kw_only=True)
class Picture(Field):
    """A picture file, its name kept as written; `heights`: read as a height map, `also`: characters it must not
    have."""

    placeholder: str = "file"
    heights: bool = False
    also: str = ""

    def parse(self, text: str) -> str:
        return file_name(text, self.also)

    def check(self, value: str) -> str:
        return file_name(value, self.also)

    def pictures(self, value: str) -> Iterator[PictureFile]:
        yield PictureFile(value, self.heights)


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
