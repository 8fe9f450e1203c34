"""Blocks of a document, which `markdown` and `page` write."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from math import isnan
from typing import Any, NamedTuple


class Heading(NamedTuple):
    """Title of the document or of a section."""

    text: str
    level: int = 2


class Text(NamedTuple):
    """A paragraph. Backticks surround code."""

    text: str


class Notice(NamedTuple):
    """A paragraph that no reader should miss."""

    text: str


class Bullets(NamedTuple):
    """A list of points."""

    items: list[str]


class Table(NamedTuple):
    """A table of text."""

    titles: list[str]
    is_number: list[bool]  # columns that are aligned to the right
    rows: list[list[str]]
    emphasised: frozenset[int] = frozenset()  # indices of rows


class Diagrams(NamedTuple):
    """The work-precision diagram, in two widths."""

    name: str
    about: str  # caption
    file: str  # of the wide one, beside the document
    wide: str  # SVG elements
    narrow: str


class Picture(NamedTuple):
    """A picture with a name."""

    name: str
    file: str
    data: bytes  # PNG


class Pictures(NamedTuple):
    """Pictures of one size to be compared: the first with another one, unless the reader chooses."""

    pictures: list[Picture]
    other: int  # index


Block = Heading | Text | Notice | Bullets | Table | Diagrams | Pictures


class Column(NamedTuple):
    """A column of a table: its title, the field of the rows that it shows, and the format of the field."""

    title: str
    field: str
    format: str = ""


def table(rows: Iterable[Any], columns: Iterable[Column], emphasised: Collection[Any] = ()) -> Table:
    """Return a table of records, with a dash for NaN."""
    rows, columns = list(rows), list(columns)
    return Table(
        [column.title for column in columns],
        [bool(column.format) for column in columns],
        [[cell(getattr(row, column.field), column.format) for column in columns] for row in rows],
        frozenset(index for index, row in enumerate(rows) if row in emphasised),
    )


def cell(value: Any, format: str) -> str:
    """Format one cell; a dash for NaN."""
    return "-" if isinstance(value, float) and isnan(value) else f"{value:{format}}"
