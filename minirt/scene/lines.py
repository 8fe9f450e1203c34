"""A line of a scene file, and the words in it.

Words are separated by blanks, which are spaces and tabs and nothing else. A `#` begins a comment wherever it stands.
"""

from __future__ import annotations

import re
from itertools import islice
from typing import NamedTuple

BOM = "\ufeff"
MAX_WORDS = 100
WORD = re.compile(r"[^ \t]+")


class Line(NamedTuple):
    """One line; columns count from 1, in characters, a byte order mark not among them."""

    number: int  # from 1
    source: str  # as it stands in the file, without the line feed
    text: str  # without byte order mark and carriage return around it

    @property
    def end(self) -> int:
        """The length of what is not comment."""
        end = self.text.find("#")
        return len(self.text) if end < 0 else end


class Word(NamedTuple):
    """Characters between blanks, or several such around a comma where the reader is lenient."""

    column: int
    raw: str  # as it stands in the line

    @property
    def text(self) -> str:
        """The word without blanks inside."""
        return "".join(self.raw.split())

    @property
    def end(self) -> int:
        """The column behind the word."""
        return self.column + len(self.raw)

    def span(self, part: int | None, start: int = 0) -> tuple[int, int]:
        """Column and length of a component, counted from 0, of the word from its character `start` on, or of it all."""
        if part is None:
            return self.column + start, len(self.raw) - start
        parts = self.raw[start:].split(",")
        before = sum(len(each) + 1 for each in parts[:part])
        blanks = len(parts[part]) - len(parts[part].lstrip())
        return self.column + start + before + blanks, len(parts[part].strip())


def line_from(number: int, source: str) -> Line:
    """The line of a file with that number."""
    text = source.removeprefix(BOM) if number == 1 else source
    return Line(number, source, text.removesuffix("\r"))


def split_at_blanks(body: str) -> list[Word]:
    """The first words of a line without its comment, more than any element has."""
    return [Word(match.start() + 1, match.group()) for match in islice(WORD.finditer(body), MAX_WORDS)]


def join_at_commas(apart: list[Word], body: str) -> list[Word]:
    """The words with those made one that meet at a comma; nothing joins the identifier in front."""
    together = apart[:1]
    for word in apart[1:]:
        last = together[-1]
        if len(together) > 1 and (word.raw.startswith(",") or last.raw.endswith(",")):
            together[-1] = Word(last.column, body[last.column - 1 : word.end - 1])
        else:
            together.append(word)
    return together
