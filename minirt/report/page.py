"""A page of text, tables and pictures from a template of Jinja, which needs no network; records as CSV and as JSON."""

from __future__ import annotations

import csv
import json
import re
from base64 import b64encode
from collections.abc import Sequence
from html import escape
from io import StringIO
from math import isfinite, isnan
from typing import Annotated, Any, NamedTuple, get_origin, get_type_hints

from minirt.helpers import package

DETAIL = "detail"  # a column that narrow windows do not show
NOTHING = {"-", "", "0", "yes"}  # cells that tell nothing, if all of a column are so


def filled(template: str, values: dict[str, Any]) -> str:
    """Fill a template with values, which are escaped in HTML."""
    from jinja2 import Environment, FunctionLoader, StrictUndefined

    loader = FunctionLoader(lambda name: package.read(__name__, name).decode())
    is_html = template.endswith(".html")
    environment = Environment(
        loader=loader, autoescape=is_html, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters |= {"columns": columns, "code": code, "base64": lambda data: b64encode(data).decode()}
    return environment.get_template(template).render(values)


def code(text: object) -> Any:
    """Escape text for HTML, in which backticks surround code."""
    from markupsafe import Markup

    return Markup(re.sub(r"`(.+?)`", r"<code>\1</code>", escape(str(text))))


class Column(NamedTuple):
    """A column of a table."""

    title: str
    kind: str  # "number", which is aligned to the right, or "word", and perhaps `DETAIL`
    cells: list[str]


def columns(rows: Sequence[Any]) -> list[Column]:
    """Return the columns of records of one type: the fields that are `Annotated` with a title, and perhaps a format and
    `DETAIL`. NaN is a dash; columns that tell nothing are left out."""
    found = []
    for field, hint in get_type_hints(type(rows[0]), include_extras=True).items() if rows else ():
        if get_origin(hint) is Annotated:
            title, form, detail = (*hint.__metadata__, "", "")[:3]
            cells = [cell(getattr(row, field), form) for row in rows]
            if not NOTHING.issuperset(cells):
                found.append(Column(title, f"{'number' if form else 'word'} {detail}".strip(), cells))
    return found


def cell(value: Any, format: str) -> str:
    """Format one cell; a dash for NaN, yes or no for truth."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "-" if isinstance(value, float) and isnan(value) else f"{value:{format}}"


def as_csv(rows: Sequence[Any]) -> str:
    """Return NamedTuples of one type as CSV: a line of field names, then a line for each."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(rows[0]._fields if rows else ())
    writer.writerows(rows)
    return text.getvalue()


def as_json(record: dict[str, Any]) -> str:
    """Return a record as JSON, with null for NaN and infinity."""
    return json.dumps(json_value(record), indent=1, allow_nan=False) + "\n"


def json_value(value: Any) -> Any:
    """Convert a value to types that JSON has: NamedTuples become objects."""
    value = value._asdict() if hasattr(value, "_asdict") else value
    if isinstance(value, dict):
        return {key: json_value(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [json_value(each) for each in value]
    return None if isinstance(value, float) and not isfinite(value) else value
