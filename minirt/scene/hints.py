"""Hints about a scene file with errors: what its lines may mean.

A hint is a line that differs from the one with the error, keeps all that it says, and is read without an error once
all hints of the file are followed; where that is uncertain there is none.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from itertools import pairwise

from minirt.element import fields_by_key, fields_of
from minirt.errors import FieldError, Problem, counted, nearest, printable
from minirt.fields import Field, Length, clamp
from minirt.fields.scalars import Scalar, number
from minirt.helpers import file_io
from minirt.materials.compound import Compound
from minirt.scene import dialect_tables as tables
from minirt.scene.dialects import PERCENT, colours_of_materials, kind_of, translated
from minirt.scene.element_reader import split_key
from minirt.scene.elements import Camera, FurtherCamera
from minirt.scene.lines import TAKEN, WORD, Line, Log, line_from
from minirt.scene.registry import nearest_element

MOST_SHOWN = 3  # lines
LONGEST = 1000  # characters of a line that a hint is about
LIKE = 0.75  # similarity of a file's name to the one that a line names, see `nearest`
# Sorts of changes that lose or guess what a line says.
UNCERTAIN = {
    *tables.UNREAD,
    *tables.GUESSES,
    tables.LEFT_OUT,
    tables.WHITE,
    tables.FOURTH,
    tables.ABSENT,
    tables.TWO_COLOURS,
    tables.PERCENT,
}


Reader = Callable[[list[str], Log], object]  # of the lines of a file: `minirt.scene.parser.read_lines`


def with_hints(errors: Iterable[Problem], sources: list[str], log: Log, read: Reader) -> Iterator[Problem]:
    """Yield the errors of a strict reader with the lines that may be meant, '' where that is unknown."""
    errors = list(errors)
    colours = colours_of_materials(sources)
    first = {code: next((n for n, each in enumerate(sources, 1) if each.split()[:1] == [code]), 0) for code in "LCc"}
    lines = {each.line: line_from(each.line, sources[each.line - 1]) for each in errors if each.line}
    hints = {number: meant(line, colours, first, log) for number, line in lines.items()}
    wrong = read_again([hints.get(number) or source for number, source in enumerate(sources, 1)], log, read)
    for each in errors:
        yield replace(each, hint="" if each.line in wrong else hints.get(each.line, ""))


def read_again(sources: list[str], log: Log, read: Reader) -> set[int]:
    """Return the numbers of the lines of a file in which a strict reader finds errors."""
    strict = Log(log.file, False, log.folder)
    read(sources, strict)
    return {each.line for each in strict.errors}


def meant(line: Line, colours: Mapping[str, str], first: Mapping[str, int], log: Log) -> str:
    """Return what a line may mean, '' where that is uncertain or the line itself.

    `first` has the numbers of the first lines that begin with L, C and c.
    """
    if len(line.text) > LONGEST:
        return ""
    code = (line.text.split() or [""])[0]
    guess = "" if kind_of(code) else nearest_element(code)
    text = with_names(with_values(line.text.replace(code, guess or code, 1)), log)
    if text.split()[:1] == [FurtherCamera.code] and first[FurtherCamera.code] == line.number and not first[Camera.code]:
        text = text.replace(FurtherCamera.code, Camera.code, 1)  # the older subject begins its only camera so
    elif text:
        seen = {code: number for code, number in first.items() if code != "c" and 0 < number < line.number}
        translation = translated(line_from(line.number, text), colours, None, seen)
        if translation is None or UNCERTAIN.intersection(sort for sort, _ in translation.changes):
            return ""
        text = translation.text if all(map(is_along_an_axis, translation.changes)) else ""
    return text if text.split() != line.text.split() else ""


def is_along_an_axis(change: tuple[str, str]) -> bool:
    """Whether a direction that was scaled is along an axis: others may be the point that is looked at, or a colour."""
    sort, words = change
    return sort != tables.SCALED or sum(bool(float(part)) for part in words.partition(TAKEN)[0].split(",")) == 1


def with_values(text: str) -> str:
    """Return a line with the numbers of its attributes in range, '' where one of them is wrong in another way."""
    kind = kind_of((text.split() or [""])[0])
    keyed = fields_by_key(kind) if kind else {}
    for word in WORD.findall(text.partition("#")[0]):
        key, start = split_key(word.replace("=", ":", 1))
        if start and key in keyed:
            value = nearest_value(keyed[key], word[start:])
            if not value:
                return ""
            text = text.replace(word, word[:start] + value)
    return text


def nearest_value(field: Field, text: str) -> str:
    """Return the value of an attribute with its numbers in range, '' where that is uncertain."""
    parts = text.split(",")
    for _ in parts:
        try:
            field.check(field.parse(text))
            break
        except FieldError as error:
            component = component_of(field, error.part or 0)
            if not isinstance(component, Scalar) or isinstance(component, Length):
                return ""
            try:
                value = number(parts[error.part or 0])
            except FieldError:
                return ""
            if 0 < value < 1 <= component.low or (component.high == 1 and value >= PERCENT):
                return ""  # glass:0.5 rather means a share, and mirror:50 one in percent
            parts[error.part or 0] = component.format(clamp(value, component.low, component.high))
            text = ",".join(parts)
    return text


def component_of(field: Field, part: int) -> Field | None:
    """Return the field of one number among the values of an attribute."""
    fields = fields_of(field.record) if isinstance(field, Compound) else [field]
    parts = [getattr(each, "component", each) for each in fields for _ in range(each.width)]
    return parts[part] if part < len(parts) else None


def with_names(text: str, log: Log) -> str:
    """Return a line that names files which are there: within quotes, or in place of one whose name is like it."""
    words = WORD.findall(text.partition("#")[0])
    whole = ""
    for word, following in pairwise([*words, ""]):
        if whole.endswith(f" {word.partition(',')[0]}") and f'"{whole}"' in text:
            continue  # the rest of a name that is now within quotes
        name = word[split_key(word)[1] :].partition(",")[0]
        if log.folder is None or '"' in name:
            continue
        path, whole = log.folder / name, f"{name} {following}".partition(",")[0]
        if following and file_io.is_file(log.folder / whole):
            text = text.replace(whole, f'"{whole}"')
        if "." not in name.strip("+-.0123456789") or file_io.is_file(path):
            continue
        with suppress(OSError, ValueError):
            there = {each.name: each for each in sorted([*path.parent.glob("*/*"), *path.parent.iterdir()])}
            if near := nearest(path.name, there, LIKE):
                text = text.replace(name, there[near[0]].relative_to(log.folder).as_posix())
    return text


def suggestions(problems: Iterable[Problem]) -> Iterator[str]:
    """Yield the first hints about a file as sentences."""
    hints = list(dict.fromkeys((each.line, each.hint) for each in problems if each.hint))
    for line, hint in hints[:MOST_SHOWN]:
        yield f"line {line}: did you mean '{printable(hint)}'?"
    if len(hints) > MOST_SHOWN:
        yield f"--check --json also has what {counted(len(hints) - MOST_SHOWN, 'further line')} may mean"
