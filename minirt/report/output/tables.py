"""Write rows of figures as CSV, JSON and Markdown."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Sequence
from io import StringIO
from math import isfinite, isnan
from typing import Any, NamedTuple

Rows = Sequence[Any]  # NamedTuples, all of one type


def as_csv(rows: Rows) -> str:
    """Return CSV: a line of field names, then a line for each row."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(rows[0]._fields if rows else ())
    writer.writerows(rows)
    return text.getvalue()


def as_json(value: Any) -> str:
    """Return JSON, with null for NaN and infinity."""
    return json.dumps(json_value(value), indent=1, allow_nan=False) + "\n"


def json_value(value: Any) -> Any:
    """Convert a value to types that JSON has: NamedTuples become objects."""
    if isinstance(value, tuple) and hasattr(value, "_asdict"):
        return json_value(value._asdict())
    if isinstance(value, dict):
        return {key: json_value(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [json_value(each) for each in value]
    return None if isinstance(value, float) and not isfinite(value) else value


class Column(NamedTuple):
    """A column of a table: its title, the field of the rows that it shows, and the format of the field."""

    title: str
    field: str
    format: str = ""


def as_markdown(rows: Rows, columns: Iterable[Column]) -> str:
    """Return a Markdown table, with a dash for NaN."""
    columns = list(columns)
    lines = ["| " + " | ".join(column.title for column in columns) + " |"]
    lines.append("|" + "|".join("---" if not column.format else "---:" for column in columns) + "|")
    lines += ["| " + " | ".join(cell(getattr(row, c.field), c.format) for c in columns) + " |" for row in rows]
    return "\n".join(lines)


def cell(value: Any, format: str) -> str:
    """Format one cell; a dash for NaN."""
    return "-" if isinstance(value, float) and isnan(value) else f"{value:{format}}"
