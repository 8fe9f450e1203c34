"""Hints about a scene file with errors: what its lines may mean.

A hint is a line that differs from the one with the error, keeps all that it says, and is read without an error once
all hints of the file are followed; where that is uncertain there is none.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from itertools import chain, islice, pairwise
from pathlib import Path
from typing import Any

from minirt.element import fields_by_key, fields_of
from minirt.errors import FieldError, Problem, counted, nearest, printable
from minirt.fields import Choice, Field
from minirt.fields.directions import SCALED
from minirt.fields.scalars import number
from minirt.helpers import file_io
from minirt.materials.compound import Compound
from minirt.scene import dialect_tables as tables
from minirt.scene.attribute_reader import split_key
from minirt.scene.dialect_fields import fit, with_words_joined
from minirt.scene.dialects import colours_of_materials, kind_of, translated
from minirt.scene.elements import FURTHER, Camera, FurtherCamera
from minirt.scene.lines import TAKEN, WORD, Line, Log, line_from
from minirt.scene.registry import nearest_element

MOST_SHOWN = 3  # lines
LONGEST = 1000  # characters of a line that a hint is about
MOST_FILES = 1000  # beside a scene, among which a name is looked for
LIKE = 0.75  # similarity of a file's name to the one that a line has, see `nearest`
SUFFIX = re.compile(r"\.[A-Za-z]\w*$")  # of a file's name
# Sorts of changes that lose or guess what a line says.
UNCERTAIN = {*tables.UNREAD, *tables.GUESSES, tables.LEFT_OUT, tables.WHITE, tables.FOURTH, tables.ABSENT}
UNCERTAIN |= {tables.TWO_COLOURS, tables.PERCENT}

Reader = Callable[[list[str], Log], object]  # of the lines of a file: `minirt.scene.parser.read_lines`


def with_hints(errors: list[Problem], sources: list[str], log: Log, read: Reader) -> Iterator[Problem]:
    """Yield the errors of a strict reader with the lines that may be meant, '' where that is unknown."""
    file = Meanings(sources, log)
    hints = {number: file.meant(line_from(number, sources[number - 1])) for number in {each.line for each in errors}}
    wrong = read_again([hints.get(number) or source for number, source in enumerate(sources, 1)], log, read)
    for each in errors:
        yield replace(each, hint="" if each.line in wrong else hints[each.line])


def read_again(sources: list[str], log: Log, read: Reader) -> set[int]:
    """Return the numbers of the lines of a file in which a strict reader finds errors."""
    strict = Log(log.file, False, log.folder)
    read(sources, strict)
    return {each.line for each in strict.errors}


class Meanings:
    """What the lines of one file may mean."""

    def __init__(self, sources: list[str], log: Log) -> None:
        self.folder = log.folder  # None: no files are looked for
        self.colours = colours_of_materials(sources)
        self.first: dict[str, int] = {}  # the first line of each kind that may be repeated under another identifier
        codes = {kind.code for pair in FURTHER.items() for kind in pair}
        for at, source in enumerate(sources, 1):
            for code in codes.intersection(source.split(maxsplit=1)[:1]):
                self.first.setdefault(code, at)

    def meant(self, line: Line) -> str:
        """Return the line that a wrong line may mean: with words mended, or translated from another program.

        '' where that is uncertain, or where it is the same line.
        """
        if len(line.text) > LONGEST or not line.text[: line.end].split():
            return ""
        words = line.text.split()
        code = words[0] if kind_of(words[0]) else nearest_element(words[0])
        joined, _ = with_words_joined(line.text)
        text = self.with_words_mended(joined.replace(words[0], code or words[0], 1))
        if code == FurtherCamera.code and self.first.get(code) == line.number and Camera.code not in self.first:
            text = text.replace(code, Camera.code, 1)  # the older subject begins its only camera so
        elif text:
            seen = {kind.code: 1 for kind in FURTHER if self.first.get(kind.code, line.number) < line.number}
            translation = translated(line_from(line.number, text), self.colours, None, seen)
            if translation is None or not all(map(is_certain, translation.changes)):
                return ""
            text = translation.text
        return text if text.split() != words else ""

    def with_words_mended(self, text: str) -> str:
        """Return a line with the numbers of its attributes in range, and names of files that are there; '' where an
        attribute is wrong in another way."""
        body, mark, comment = text.partition("#")
        for word, following in pairwise(body.split(" ")):
            name = f"{word[split_key(word)[1] :]} {following}".partition(",")[0]
            if following and self.is_there(name):
                body = body.replace(name, f'"{name}"')
        kind = kind_of(body.split()[0])
        keyed = fields_by_key(kind) if kind else {}
        with suppress(FieldError):
            return WORD.sub(lambda found: self.word_mended(found[0], keyed), body) + mark + comment
        return ""

    def word_mended(self, word: str, keyed: dict[str, Field]) -> str:
        """Return a word with its numbers in range and a name that is there; FieldError where that is uncertain."""
        key, start = split_key(word.replace("=", ":", 1))
        value = nearest_value(keyed[key], word[start:]) if start and key in keyed else word[start:]
        name = value.partition(",")[0]
        if SUFFIX.search(name) and not self.is_there(name):
            value = self.nearest_name(name.replace("\\", "/")) + value[len(name) :]
        return word[:start] + value

    def is_there(self, name: str) -> bool:
        """Whether a name is that of a file of the scene."""
        return self.folder is not None and file_io.is_file(file_io.located(self.folder, name))

    def nearest_name(self, name: str) -> str:
        """Return the name of a file beside the scene, or in a folder there, that is like a name; or this itself."""
        if self.is_there(name):
            return name
        near = nearest(name.rpartition("/")[2].lower(), self.files, LIKE)
        return self.files[near[0]] if near else name

    @cached_property
    def files(self) -> dict[str, str]:
        """The names of files beside the scene and in the folders there, by their last parts in small letters."""
        found: dict[str, str] = {}
        with suppress(OSError):
            folder = self.folder or Path()
            for path in islice(chain(folder.glob("*/*"), folder.iterdir()), MOST_FILES):
                found[path.name.lower()] = path.relative_to(folder).as_posix()
        return found


def is_certain(change: tuple[str, str]) -> bool:
    """Whether a change keeps what a line says. A direction that is scaled does where it is along an axis: another may
    be the point that is looked at, or a colour."""
    sort, words = change
    if sort == SCALED:
        return sum(bool(float(part)) for part in words.partition(TAKEN)[0].split(",")) == 1
    return sort not in UNCERTAIN


def nearest_value(field: Field, text: str) -> str:
    """Return the text of an attribute's value with its numbers in range and its words spelled right.

    FieldError where that is uncertain.
    """
    parts = text.split(",")
    for _ in parts:  # each turn mends the first wrong part
        try:
            field.check(field.parse(",".join(parts)))
            break
        except FieldError as error:
            part = error.part or 0
            component = component_of(field, part)
            if isinstance(component, Choice):
                parts[part] = next(iter(nearest(parts[part].lower(), component.words)), "")
                continue
            value = number(parts[part])
            fitted, sort = fit(component, value)
            # A number below 1, where the least value is 1, rather means a share, as in glass:0.5.
            if sort != tables.NEAREST or 0 < value < component.low == 1:
                raise
            parts[part] = component.format(fitted)
    return ",".join(parts)


def component_of(field: Field, part: int) -> Any:
    """Return the field of one number among the values of an attribute; FieldError where it has none."""
    fields = fields_of(field.record) if isinstance(field, Compound) else [field]
    parts = [getattr(each, "component", each) for each in fields for _ in range(each.width)]
    if part >= len(parts):
        raise FieldError("has too many values")
    return parts[part]


def suggestions(problems: Iterable[Problem]) -> Iterator[str]:
    """Yield the first hints about a file as sentences."""
    hints = list(dict.fromkeys((each.line, each.hint) for each in problems if each.hint))
    for line, hint in hints[:MOST_SHOWN]:
        yield f"line {line}: did you mean '{printable(hint)}'?"
    if len(hints) > MOST_SHOWN:
        yield f"--check --json prints the hints about {counted(len(hints) - MOST_SHOWN, 'further line')}"
