"""Lines of a scene file and their words.

Blanks (spaces and tabs, nothing else) separate words. A `#` begins a comment wherever it stands.
"""

from __future__ import annotations

import re
from itertools import islice
from typing import NamedTuple

BOM = "\ufeff"  # byte order mark
MAX_WORDS = 100  # of a line; more than any element has
WORD = re.compile(r"[^ \t]+")


class Line(NamedTuple):
    """A line of a scene file; columns count characters from 1, without a byte order mark."""

    number: int  # from 1
    source: str  # as it stands in the file, without the line feed
    text: str  # without byte order mark and carriage return

    @property
    def end(self) -> int:
        """Length of the line without its comment."""
        end = self.text.find("#")
        return len(self.text) if end < 0 else end


class Word(NamedTuple):
    """A word of a line; a lenient reader joins words that meet at a comma into one."""

    column: int
    raw: str  # as it stands in the line

    @property
    def text(self) -> str:
        """Text of the word without blanks inside."""
        return "".join(self.raw.split())

    @property
    def end(self) -> int:
        """Column behind the word."""
        return self.column + len(self.raw)

    def span(self, part: int | None, start: int = 0) -> tuple[int, int]:
        """Return column and length of component `part`, from 0, of the word from character `start` on; None: of all."""
        if part is None:
            return self.column + start, len(self.raw) - start
        parts = self.raw[start:].split(",")
        before = sum(len(component) + 1 for component in parts[:part])
        blanks = len(parts[part]) - len(parts[part].lstrip())
        return self.column + start + before + blanks, len(parts[part].strip())


def line_from(number: int, source: str) -> Line:
    """Return line `number` of a file."""
    text = source.removeprefix(BOM) if number == 1 else source
    return Line(number, source, text.removesuffix("\r"))


def first_unprintable(line: Line) -> int:
    """Return the index of the first carriage return, or of the first character before the comment that cannot be seen.

    Tabs are seen. The search halves the line, so that no loop in Python looks at each character.
    """
    carriage_return = line.text.find("\r")
    start, end = 0, carriage_return if 0 <= carriage_return < line.end else line.end
    body = line.text[:end].replace("\t", " ")
    if body.isprintable():
        return carriage_return
    while end - start > 1:
        middle = (start + end) // 2
        if body[start:middle].isprintable():
            start = middle
        else:
            end = middle
    return start


def split_at_blanks(body: str) -> list[Word]:
    """Return the words of a line without its comment, `MAX_WORDS` at most."""
    return [Word(match.start() + 1, match.group()) for match in islice(WORD.finditer(body), MAX_WORDS)]


def join_at_commas(words: list[Word], body: str) -> list[Word]:
    """Join words that meet at a comma; the identifier, the first word, stays alone."""
    joined = words[:1]
    for word in words[1:]:
        last = joined[-1]
        if len(joined) > 1 and (word.raw.startswith(",") or last.raw.endswith(",")):
            joined[-1] = Word(last.column, body[last.column - 1 : word.end - 1])
        else:
            joined.append(word)
    return joined
