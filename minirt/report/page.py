"""A document written twice: as Markdown, and as one HTML page that needs no other file and no network."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Collection, Iterable, Sequence
from html import escape
from math import isnan
from pathlib import Path
from typing import Any, NamedTuple

FOLDER = Path(__file__).parent
# The browser itself refuses whatever is not in the page.
POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'"
HEAD = f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1"><meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy" content="{POLICY}"><link rel="icon" href="data:,">"""
# Two pictures with a slider between them, which the script fills and shows.
COMPARISON = """<figure class="comparison" data-other="{}" hidden>
<div class="panes"><img alt="" class="left"><img alt="" class="right"><i class="edge"></i></div>
<div class="controls"><select class="left" aria-label="left picture"></select>
<input type="range" min="0" max="100" value="50" step="any" aria-label="border of the pictures">
<select class="right" aria-label="right picture"></select></div></figure>"""


class Column(NamedTuple):
    """A column of a table: its title, the field of the rows that it shows, and the format of the field."""

    title: str
    field: str
    format: str = ""


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

    def heading(self, text: str, level: int = 2) -> None:
        """Add the title of a section."""
        self.markdown.append(f"{'#' * level} {text}")
        self.html.append(f"<h{level}>{inline(text)}</h{level}>")

    def text(self, text: str) -> None:
        """Add a paragraph."""
        self.markdown.append(text)
        self.html.append(f"<p>{inline(text)}</p>")

    def notice(self, text: str) -> None:
        """Add a paragraph that no reader should miss."""
        self.markdown.append(f"**{text}**")
        self.html.append(f'<p class="notice" role="alert">{inline(text)}</p>')

    def bullets(self, items: Iterable[str]) -> None:
        """Add a list of points."""
        items = list(items)
        self.markdown.append("\n".join(f"- {item}" for item in items))
        self.html.append(f"<ul>{''.join(f'<li>{inline(item)}</li>' for item in items)}</ul>")

    def table(self, rows: Sequence[Any], columns: Sequence[Column], emphasised: Collection[Any] = ()) -> None:
        """Add a table of records, with a dash for NaN; it scrolls sideways where it is wider than the screen."""
        titles = "".join(f'<th class="{kind(column)}">{inline(column.title)}</th>' for column in columns)
        lines = ["| " + " | ".join(column.title for column in columns) + " |"]
        lines.append("|" + "|".join("---:" if column.format else "---" for column in columns) + "|")
        html = []
        for row in rows:
            cells = [cell(getattr(row, column.field), column.format) for column in columns]
            first, *others = (each.replace("|", r"\|") for each in cells)
            lines.append("| " + " | ".join([f"**{first}**" if row in emphasised else first, *others]) + " |")
            data = (f'<td class="{kind(each)}">{inline(text)}</td>' for each, text in zip(columns, cells, strict=True))
            html.append(f'<tr class="{"emphasised" if row in emphasised else "plain"}">{"".join(data)}</tr>')
        self.markdown.append("\n".join(lines))
        body = f"<table><thead><tr>{titles}</tr></thead><tbody>{''.join(html)}</tbody></table>"
        self.html.append(f'<div class="scroll" tabindex="0">{body}</div>')

    def chart(self, name: str, file: str, about: str, wide: str, narrow: str) -> None:
        """Add a chart as SVG elements in two widths; Markdown shows a file beside it."""
        self.markdown += [f"![{name}]({file})", about]
        both = f'<div class="wide">{wide}</div><div class="narrow">{narrow}</div>'
        self.html.append(f'<figure class="diagrams">{both}<figcaption>{inline(about)}</figcaption></figure>')

    def pictures(self, pictures: Iterable[Picture], other: int) -> None:
        """Add pictures to compare: the first with that of index `other`, unless the reader chooses. The page alone
        shows them."""
        images = "".join(
            f'<figure><img alt="{escape(each.name)}" src="data:image/png;base64,{b64encode(each.data).decode()}" '
            f'decoding="async"><figcaption>{inline(each.name)}</figcaption></figure>'
            for each in pictures
        )
        self.html += [COMPARISON.format(other), f'<div class="pictures">{images}</div>']

    def as_markdown(self) -> str:
        """Return the document as Markdown, an empty line between two blocks."""
        return "\n\n".join(self.markdown) + "\n"

    def as_page(self) -> str:
        """Return the document as a page."""
        style, script = ((FOLDER / name).read_text(encoding="utf-8") for name in ("page.css", "page.js"))
        head = f"{HEAD}\n<title>{escape(self.title)}</title><style>{style}</style></head>"
        body = "\n".join(self.html)
        return f"{head}\n<body><main>{body}\n<script>{script}</script></main></body></html>\n"


def kind(column: Column) -> str:
    """Return the style of a column: numbers are aligned to the right."""
    return "number" if column.format else "word"


def inline(text: str) -> str:
    """Escape text; backticks surround code."""
    return re.sub(r"`(.+?)`", r"<code>\1</code>", escape(text))


def cell(value: Any, format: str) -> str:
    """Format one cell; a dash for NaN, yes or no for truth."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "-" if isinstance(value, float) and isnan(value) else f"{value:{format}}"
