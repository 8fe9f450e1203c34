"""Write a document as one HTML page that needs no other file and no network."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Iterable
from html import escape
from pathlib import Path

from minirt.report.output.blocks import Block, Bullets, Diagrams, Heading, Notice, Picture, Pictures, Table, Text
from minirt.report.output.svg import element

FOLDER = Path(__file__).parent
# The browser itself refuses whatever is not in the page.
POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'"


def page(title: str, blocks: Iterable[Block]) -> str:
    """Return the blocks as a page."""
    head = [
        element("meta", charset="utf-8"),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("meta", name="color-scheme", content="light dark"),
        element("meta", http_equiv="Content-Security-Policy", content=POLICY),
        element("link", rel="icon", href="data:,"),
        element("title", escape(title)),
        element("style", source("page.css"), source("diagram.css")),
    ]
    body = [*map(block_html, blocks), element("script", source("page.js"))]
    html = element("html", element("head", *head), element("body", element("main", "\n".join(body))), lang="en")
    return f"<!doctype html>\n{html}\n"


def source(name: str) -> str:
    """Read a style sheet or a script of this folder."""
    return (FOLDER / name).read_text(encoding="utf-8")


def block_html(block: Block) -> str:
    """Write one block."""
    match block:
        case Heading(text, level):
            written = element(f"h{level}", inline(text))
        case Text(text):
            written = element("p", inline(text))
        case Notice(text):
            written = element("p", inline(text), class_="notice", role="alert")
        case Bullets(items):
            written = element("ul", *(element("li", inline(item)) for item in items))
        case Table():
            written = table_html(block)
        case Diagrams(_, about, _, wide, narrow):
            both = element("div", wide, class_="wide"), element("div", narrow, class_="narrow")
            written = element("figure", *both, element("figcaption", inline(about)), class_="diagrams")
        case Pictures(pictures, other):
            written = comparison(other) + element("div", *map(picture_html, pictures), class_="pictures")
    return written


def inline(text: str) -> str:
    """Escape text; backticks surround code."""
    return re.sub(r"`(.+?)`", r"<code>\1</code>", escape(text))


def table_html(table: Table) -> str:
    """Write a table that scrolls sideways where it is wider than the screen."""
    styles = ["number" if is_number else "word" for is_number in table.is_number]
    titles = (element("th", inline(each), class_=style) for each, style in zip(table.titles, styles, strict=True))
    rows = []
    for number, row in enumerate(table.rows):
        cells = [element("td", inline(each), class_=style) for each, style in zip(row, styles, strict=True)]
        rows.append(element("tr", *cells, class_="emphasised" if number in table.emphasised else "plain"))
    content = element("thead", element("tr", *titles)), element("tbody", *rows)
    return element("div", element("table", *content), class_="scroll", tabindex=0)


def picture_html(picture: Picture) -> str:
    """Write a picture of the grid, with its data inside."""
    data = f"data:image/png;base64,{b64encode(picture.data).decode()}"
    image = element("img", alt=picture.name, src=data, decoding="async")
    return element("figure", image, element("figcaption", inline(picture.name)))


def comparison(other: int) -> str:
    """Write the two pictures with a slider between them, which the script fills and shows."""
    panes = (
        element("img", alt="", class_="left"),
        element("img", alt="", class_="right"),
        element("i", "", class_="edge"),
    )
    slider = element("input", type="range", min=0, max=100, value=50, step="any", aria_label="border of the pictures")
    controls = (
        element("select", "", class_="left", aria_label="left picture"),
        slider,
        element("select", "", class_="right", aria_label="right picture"),
    )
    content = element("div", *panes, class_="panes"), element("div", *controls, class_="controls")
    return f'<figure class="comparison" data-other="{other}" hidden>{"".join(content)}</figure>'
