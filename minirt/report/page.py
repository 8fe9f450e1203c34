"""Tables of records and a document of text, tables and pictures, written as Markdown and as one HTML page that needs no
other file and no network; records as CSV and as JSON."""

from __future__ import annotations

import csv
import json
import re
from base64 import b64encode
from collections.abc import Collection, Iterable, Sequence
from html import escape
from io import StringIO
from math import isfinite, isnan
from pathlib import Path
from typing import Any, NamedTuple, get_args, get_type_hints

FOLDER = Path(__file__).parent


class Column(NamedTuple):
    """A column of a table: the field of the records that it shows, its title, and the format of numbers."""

    field: str
    title: str
    format: str = ""


def columns(record: type) -> list[Column]:
    """Return the columns of a table of records: the fields that are `Annotated` with a title, and perhaps a format."""
    hints = get_type_hints(record, include_extras=True)
    return [Column(field, *get_args(hint)[1:]) for field, hint in hints.items() if get_args(hint)[1:]]


class Picture(NamedTuple):
    """A picture with a name."""

    name: str
    file: str
    data: bytes  # PNG


class Document:
    """Blocks in their order, each in both forms. Backticks in text surround code."""

    def __init__(self, title: str) -> None:
        self.title = title
        self.markdown: list[str] = []
        self.html: list[str] = []
        self.heading(title, 1)

    def add(self, markdown: str, html: str) -> None:
        """Add a block in both forms."""
        self.markdown.append(markdown)
        self.html.append(html)

    def heading(self, text: str, level: int = 2) -> None:
        """Add the title of a section."""
        self.add(f"{'#' * level} {text}", f"<h{level}>{inline(text)}</h{level}>")

    def text(self, text: str) -> None:
        """Add a paragraph."""
        self.add(text, f"<p>{inline(text)}</p>")

    def notice(self, text: str) -> None:
        """Add a paragraph that no reader should miss."""
        self.add(f"**{text}**", f'<p class="notice" role="alert">{inline(text)}</p>')

    def bullets(self, items: Iterable[str]) -> None:
        """Add a list of points."""
        items = list(items)
        points = "".join(f"<li>{inline(item)}</li>" for item in items)
        self.add("\n".join(f"- {item}" for item in items), f"<ul>{points}</ul>")

    def section(self, title: str, text: str, rows: Sequence[Any], emphasised: Collection[Any] = ()) -> None:
        """Add a heading, a paragraph and a table of records, with a dash for NaN; nothing where there are no records.

        The table scrolls sideways where it is wider than the screen.
        """
        if not rows:
            return
        self.heading(title)
        self.text(text)
        shown = columns(type(rows[0]))
        kinds = ["number" if column.format else "word" for column in shown]  # numbers are aligned to the right
        titles = [column.title for column in shown]
        rules = ("---:" if column.format else "---" for column in shown)
        markdown = [f"| {' | '.join(titles)} |", f"|{'|'.join(rules)}|"]
        html = [cells("th", kinds, titles)]
        for row in rows:
            texts = [cell(getattr(row, column.field), column.format) for column in shown]
            first, *others = (each.replace("|", r"\|") for each in texts)
            best = row in emphasised
            markdown.append(f"| {' | '.join([f'**{first}**' if best else first, *others])} |")
            html.append(f'<tr class="{"emphasised" if best else "plain"}">{cells("td", kinds, texts)}</tr>')
        body = f"<table><thead><tr>{html[0]}</tr></thead><tbody>{''.join(html[1:])}</tbody></table>"
        self.add("\n".join(markdown), f'<div class="scroll" tabindex="0">{body}</div>')

    def chart(self, name: str, file: str, about: str, wide: str, narrow: str) -> None:
        """Add a chart as SVG elements in two widths; Markdown shows a file beside it."""
        both = f'<div class="wide">{wide}</div><div class="narrow">{narrow}</div>'
        html = f'<figure class="diagrams">{both}<figcaption>{inline(about)}</figcaption></figure>'
        self.add(f"![{name}]({file})\n\n{about}", html)

    def pictures(self, pictures: Iterable[Picture], other: int) -> None:
        """Add pictures to compare: the first with that of index `other`, unless the reader chooses. The page alone
        shows them."""
        images = "".join(
            f'<figure><img alt="{escape(each.name)}" src="data:image/png;base64,{b64encode(each.data).decode()}" '
            f'decoding="async"><figcaption>{inline(each.name)}</figcaption></figure>'
            for each in pictures
        )
        self.html.append(f'<div class="pictures" data-other="{other}">{images}</div>')

    def as_markdown(self) -> str:
        """Return the document as Markdown, an empty line between two blocks."""
        return "\n\n".join(self.markdown) + "\n"

    def as_page(self) -> str:
        """Return the document as a page."""
        page, style, script = ((FOLDER / f"page.{kind}").read_text(encoding="utf-8") for kind in ("html", "css", "js"))
        return page.format(title=escape(self.title), style=style, body="\n".join(self.html), script=script)


def cells(tag: str, kinds: Iterable[str], texts: Iterable[str]) -> str:
    """Return the cells of a row in HTML."""
    return "".join(f'<{tag} class="{kind}">{inline(text)}</{tag}>' for kind, text in zip(kinds, texts, strict=True))


def inline(text: str) -> str:
    """Escape text; backticks surround code."""
    return re.sub(r"`(.+?)`", r"<code>\1</code>", escape(text))


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
