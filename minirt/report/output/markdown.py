"""Write a document as Markdown."""

from __future__ import annotations

from collections.abc import Iterable

from minirt.report.output.blocks import Block, Bullets, Diagrams, Heading, Notice, Pictures, Table, Text


def markdown(blocks: Iterable[Block]) -> str:
    """Return the blocks as Markdown, an empty line between two."""
    return "\n\n".join(written for block in blocks if (written := block_text(block))) + "\n"


def block_text(block: Block) -> str:
    """Write one block. Pictures to compare are files of their own, which the page alone shows."""
    match block:
        case Heading(text, level):
            written = f"{'#' * level} {text}"
        case Text(text):
            written = text
        case Notice(text):
            written = f"**{text}**"
        case Bullets(items):
            written = "\n".join(f"- {item}" for item in items)
        case Table():
            written = table_text(block)
        case Diagrams(name, about, file):
            written = f"![{name}]({file})\n\n{about}"
        case Pictures():
            written = ""
    return written


def table_text(table: Table) -> str:
    """Write a table; emphasised rows are bold in their first column."""
    lines = ["| " + " | ".join(table.titles) + " |"]
    lines.append("|" + "|".join("---:" if is_number else "---" for is_number in table.is_number) + "|")
    for number, row in enumerate(table.rows):
        first, *others = (each.replace("|", r"\|") for each in row)
        lines.append("| " + " | ".join([f"**{first}**" if number in table.emphasised else first, *others]) + " |")
    return "\n".join(lines)
