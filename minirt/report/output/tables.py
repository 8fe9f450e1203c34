"""Write rows of figures as CSV and JSON."""

from __future__ import annotations

import csv
import json
from collections.abc import Sequence
from io import StringIO
from math import isfinite
from typing import Any

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
