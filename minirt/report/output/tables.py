"""Rows of figures as CSV, as JSON and as Markdown."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Sequence
from io import StringIO
from math import isfinite, isnan
from typing import Any, NamedTuple

Rows = Sequence[Any]  # NamedTuples, all of one type


def as_csv(rows: Rows) -> str:
    """A line of names, and a line for each row."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(rows[0]._fields if rows else ())
    writer.writerows(rows)
    return text.getvalue()


def as_json(value: Any) -> str:
    """JSON, in which NaN and infinity are null."""
    return json.dumps(plain(value), indent=1, allow_nan=False) + "\n"


def plain(value: Any) -> Any:
    """What JSON has: rows are objects."""
    if isinstance(value, tuple) and hasattr(value, "_asdict"):
        return plain(value._asdict())
    if isinstance(value, dict):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(each) for each in value]
    return None if isinstance(value, float) and not isfinite(value) else value


class Column(NamedTuple):
    """A column of a table: what stands above it, which field of the rows it shows and how that is written."""

    title: str
    field: str
    format: str = ""


def as_markdown(rows: Rows, columns: Iterable[Column]) -> str:
    """A table; what is NaN is a dash."""
    columns = list(columns)
    lines = ["| " + " | ".join(column.title for column in columns) + " |"]
    lines.append("|" + "|".join("---" if not column.format else "---:" for column in columns) + "|")
    lines += ["| " + " | ".join(cell(getattr(row, c.field), c.format) for c in columns) + " |" for row in rows]
    return "\n".join(lines)


def cell(value: Any, format: str) -> str:
    """A figure as it is written; NaN as a dash."""
    return "-" if isinstance(value, float) and isnan(value) else f"{value:{format}}"
