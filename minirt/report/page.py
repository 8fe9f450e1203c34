"""A page of text, tables and pictures, as Markdown and as HTML that needs no network; records as CSV and as JSON."""

from __future__ import annotations

import csv
import json
import re
from base64 import b64encode
from collections.abc import Collection, Iterable, Sequence
from html import escape
from io import StringIO
from math import isfinite, isnan
from typing import Annotated, Any, get_origin, get_type_hints

from minirt.helpers import package

MARKS = {
    r"`(.+?)`": r"<code>\1</code>",
    r"\*\*(.+?)\*\*": r"<b>\1</b>",
    r"\[([^]]+)\]\(([\w.-]+)\)": r'<a href="\2">\1</a>',
}
NOTHING = {"-", "", "0", "yes"}  # cells that tell nothing, if all of a column are so


def filled(title: str, values: dict[str, Any]) -> tuple[str, str]:
    """Fill the template `page.txt` with values; return it as Markdown and as HTML.

    A section that lacks a value is left out. Blocks that begin with "<div" are for HTML alone, those with "!" for
    Markdown.
    """
    kinds = "txt", "html", "css", "js"
    template, page, style, script = (package.read(__name__, f"page.{kind}").decode() for kind in kinds)
    markdown, html = list[str](), list[str]()
    for section in re.split(r"\n(?=## )", template):
        if all(values[name] for name in re.findall(r"{(\w+)}", section)):
            blocks = section.format_map(values).strip().split("\n\n")
            markdown += [block for block in blocks if not block.startswith("<div")]
            name = escape(blocks[0].strip("# ").replace(" ", "-").lower())
            body = (block if block.startswith("<div") else as_html(block) for block in blocks if block[0] != "!")
            html.append(f'<section id="{name}">{"".join(body)}</section>')
    filled = page.format(title=escape(title), style=style, body="\n".join(html), script=script)
    return "\n\n".join(markdown) + "\n", filled


def bullets(items: Iterable[object]) -> str:
    """Return a list of points in Markdown."""
    return "\n".join(f"- {' '.join(str(item).split())}" for item in items)


def table(rows: Sequence[Any], emphasised: Collection[Any] = ()) -> str:
    """Return a table of records in Markdown: the fields that are `Annotated` with a title, and perhaps a format.

    NaN is a dash; columns that tell nothing are left out.
    """
    if not rows:
        return ""
    texts = list[list[str]]()  # of the columns: title, rule, and a cell for each record
    for field, hint in get_type_hints(type(rows[0]), include_extras=True).items():
        if get_origin(hint) is Annotated:
            title, form = (*hint.__metadata__, "")[:2]
            cells = [cell(getattr(row, field), form).replace("|", r"\|") for row in rows]
            if not NOTHING.issuperset(cells):
                texts.append([title, "---:" if form else "---", *cells])
    texts[0][2:] = [f"**{text}**" if row in emphasised else text for row, text in zip(rows, texts[0][2:], strict=True)]
    return "\n".join(f"| {' | '.join(line)} |" for line in zip(*texts, strict=True))


def figures(kind: str, figures: Iterable[dict[str, bytes]]) -> str:
    """Return figures in HTML, each of PNG pictures by their names, the first of which is its caption.

    Of the kind "pictures" the page shows two at a time, which the reader chooses.
    """
    html = []
    for pictures in figures:
        data = ((escape(name), b64encode(png).decode()) for name, png in pictures.items())
        images = (f'<img alt="{name}" src="data:image/png;base64,{text}">' for name, text in data)
        html.append(f"<figure>{''.join(images)}<figcaption>{inline(next(iter(pictures)))}</figcaption></figure>")
    return f'<div class="{kind}">{"".join(html)}</div>'


def as_html(block: str) -> str:
    """Convert a block of Markdown: a heading, a list, a table or a paragraph."""
    lines = inline(block).splitlines()
    sign, _, text = lines[0].partition(" ")
    if set(sign) == {"#"}:
        return f"<h{len(sign)}>{text}</h{len(sign)}>"
    if sign == "-":
        return f"<ul>{''.join(f'<li>{line[2:]}</li>' for line in lines)}</ul>"
    if sign != "|":
        return f"<p>{' '.join(lines)}</p>"
    head, rules, *rows = ([text.replace(r"\|", "|") for text in line[2:-2].split(" | ")] for line in lines)
    kinds = ["number" if rule.endswith(":") else "word" for rule in rules]  # numbers are aligned to the right
    html = []
    for tag, row in [("th", head), *(("td", row) for row in rows)]:
        cells = (f'<{tag} class="{kind}">{text}</{tag}>' for kind, text in zip(kinds, row, strict=True))
        html.append(f'<tr class="{"emphasised" if row[0].startswith("<b>") else "plain"}">{"".join(cells)}</tr>')
    return f'<div class="scroll" tabindex="0"><table>{"".join(html)}</table></div>'


def inline(text: str) -> str:
    """Escape text; backticks surround code, two stars what is bold, and [text](file) is a link."""
    text = escape(text)
    for pattern, html in MARKS.items():
        text = re.sub(pattern, html, text)
    return text


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
