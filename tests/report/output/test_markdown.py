"""Documents are written as Markdown."""

from __future__ import annotations

from math import nan
from typing import NamedTuple

from minirt.report.output.blocks import Bullets, Column, Diagrams, Heading, Notice, Pictures, Text, table
from minirt.report.output.markdown import markdown


class Row(NamedTuple):
    name: str
    error: float


ROWS = [Row("a, b", 0.1 + 0.2), Row("c|d", nan)]
COLUMNS = Column("name", "name"), Column("error", "error", ".2f")


def test_a_table_has_a_dash_for_nan_and_shows_what_stands_out() -> None:
    lines = ["| name | error |", "|---|---:|", "| a, b | 0.30 |", r"| **c\|d** | - |"]
    assert markdown([table(ROWS, COLUMNS, [ROWS[1]])]).splitlines() == lines


def test_blocks_stand_apart() -> None:
    blocks = [
        Heading("Title", 1),
        Notice("Mind"),
        Text("words"),
        Bullets(["one", "two"]),
        Diagrams("Name", "About.", "x.svg", "<svg/>", "<svg/>"),
        Pictures([], 0),
        Heading("End"),
    ]
    expected = "# Title\n\n**Mind**\n\nwords\n\n- one\n- two\n\n![Name](x.svg)\n\nAbout.\n\n## End\n"
    assert markdown(blocks) == expected
