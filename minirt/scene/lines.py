"""Lines of a scene file, their words, and the log of the errors and notices about them.

Blanks (spaces and tabs, nothing else) separate words. A `#` begins a comment wherever it stands.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from minirt.errors import Problem
from minirt.fields.scalars import code_point_name

BOM = "\ufeff"  # byte order mark
MAX_ERRORS = 1000  # in one file; a file with more is not a scene
MAX_ERRORS_OF_LINE = 20
MAX_NOTICES = 1000
MOST_NAMED = 8  # words of one sort in a notice
MAX_WORDS = 100  # of a line; more than any element has
TAKEN = " to "  # between the words of a change and what was taken for them
SLASHES = re.compile(r"(?<![^ \t])//")  # which begin a comment in other programs
HEX_COLOUR = re.compile(r"#(?:[0-9A-Fa-f]{6}|[0-9A-Fa-f]{3})(?![^ \t])")
WORD = re.compile(r'(?:"[^"]*+"|[^ \t])++')  # blanks may stand within quotes


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
    """A word of a line."""

    column: int
    text: str

    @property
    def end(self) -> int:
        """Column behind the word."""
        return self.column + len(self.text)

    def span(self, part: int | None, start: int = 0) -> tuple[int, int]:
        """Return column and length of component `part`, from 0, of the word from character `start` on; None: of all."""
        if part is None:
            return self.column + start, len(self.text) - start
        parts = self.text[start:].split(",")
        return self.column + start + sum(len(each) + 1 for each in parts[:part]), len(parts[part])


def line_from(number: int, source: str) -> Line:
    """Return line `number` of a file."""
    text = source.removeprefix(BOM) if number == 1 else source
    return Line(number, source, text.removesuffix("\r"))


def first_unprintable(line: Line) -> int:
    """Return the index of the first carriage return, or of a character before the comment that is not seen, or -1."""
    body = line.text[: line.end].replace("\t", " ")
    if "\r" not in line.text and body.isprintable():
        return -1
    return next((index for index, each in enumerate(body) if not each.isprintable()), line.text.find("\r"))


def words_of(body: str) -> list[Word]:
    """Return at most `MAX_WORDS` words of a line without its comment."""
    return [Word(match.start() + 1, match[0]) for match in islice(WORD.finditer(body), MAX_WORDS)]


class Log:
    """The errors and notices of one scene file."""

    def __init__(self, file: str, lenient: bool | str, folder: Path | None = None) -> None:
        """Make an empty log of a file. The scene's file names are relative to `folder`, by default that of the file;
        without either, as for `file` '', named files are not opened."""
        self.file = file
        self.folder = Path(file).parent if file and not folder else folder
        self.lenient = lenient
        self.errors: list[Problem] = []
        self.notices: list[Problem] = []
        self.changes: dict[str, list[tuple[Line, str]]] = {}  # by a lenient reader, of each sort: lines and words

    def error(self, line: Line, message: str, column: int, length: int = 1) -> None:
        """Add an error; a file with errors is refused. The last of too many in a line says that there are more."""
        of_line = [each.line for each in self.errors[-MAX_ERRORS_OF_LINE:]].count(line.number)
        if of_line == MAX_ERRORS_OF_LINE:
            return
        if of_line == MAX_ERRORS_OF_LINE - 1:
            message = "too many errors in this line: further ones are left out"
        self.errors.append(Problem(self.file, line.number, column, line.text, message, max(1, length)))

    def notice(self, line: Line, message: str, column: int, length: int = 1) -> None:
        """Add a notice about a file that is accepted. The last of too many says that there are more."""
        if len(self.notices) == MAX_NOTICES:
            message = "too many notices: those from here on are left out"
        if len(self.notices) <= MAX_NOTICES:
            self.notices.append(Problem(self.file, line.number, column, line.text, message, max(1, length)))

    def change(self, line: Line, sort: str, words: str) -> None:
        """Note what a reader did to the words of a line, or to the whole line, whose first word they are."""
        self.changes.setdefault(sort, []).append((line, words))

    def tell_changes(self) -> None:
        """Add one notice for each sort of change; for a lenient reader, leave one notice of each message.

        A notice about changes stands at the first of them, and names the words that they are about. Of the notices with
        one message the first stays, and tells in how many places it holds.
        """
        if self.lenient:
            first: dict[str, Problem] = {}
            for each in self.notices:
                first.setdefault(each.message, each)
            places = Counter(each.message for each in self.notices)
            self.notices = [replace(each, message=told(message, places[message])) for message, each in first.items()]
        for sort, changes in self.changes.items():
            line, first_words = changes[0]
            about = [*dict.fromkeys(words for _, words in changes)]
            named = ", ".join(about[:MOST_NAMED]) + (", ..." if len(about) > MOST_NAMED else "")
            old = first_words.partition(TAKEN)[0]
            found = re.search(rf"(?<![^ \t]){re.escape(old)}(?![^ \t])", line.text)
            column = found.start() if found else max(0, line.text.find(old))
            self.notice(line._replace(text=""), told(f"{sort}: {named}", len(changes)), column + 1, len(old))


def told(message: str, places: int) -> str:
    """Return a message about so many places."""
    return f"{message} ({places} places)" if places > 1 else message


def split_line(line: Line, log: Log) -> list[Word] | None:
    """Return the words of a line, [] for a comment or a blank line; None after an error, which goes into the log."""
    hidden = first_unprintable(line)
    if hidden >= 0:
        message = "a carriage return ends a line only together with a line feed"
        if line.text[hidden] != "\r":
            message = f"only spaces and tabs separate fields, got {code_point_name(line.text[hidden])}"
        log.error(line, message, hidden + 1)
        return None
    body = line.text[: line.end]
    slashes = SLASHES.search(body) if "//" in body else None
    words = words_of(body)
    # The column, from 1, of the first blank beside a comma; 0 for none.
    blank = next((word.column - 1 for word in words[2:] if word.text.startswith(",")), 0)
    blank = blank or next((word.end - 1 for word in words[1:-1] if word.text.endswith(",")), 0)
    if slashes:
        log.error(line, "a comment begins with '#', got '//'", slashes.start() + 1, 2)
    elif blank:
        log.error(line, "no blanks may stand around a comma", blank, 2)
    return None if slashes or blank else words
