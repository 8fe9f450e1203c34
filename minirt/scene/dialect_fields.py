"""Words of a line of another program, and the fields of an element that each word may be meant as."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import Any, NamedTuple

from minirt.element import Element, positional_fields
from minirt.errors import FieldError, quoted
from minirt.fields import Colour, Direction, Field, Real, Three, Whole, clamp, unit
from minirt.fields.directions import SCALED
from minirt.fields.scalars import Scalar
from minirt.scene import dialect_tables as tables
from minirt.scene.dialect_tables import NUMBER
from minirt.scene.lines import HEX_COLOUR, MAX_WORDS, SLASHES, TAKEN, Line, first_unprintable
from minirt.scene.registry import NUMERIC

LEAST_PERCENT = 10  # a share from here on is one in percent
# Blanks may stand around the commas of three numbers, and within quotes.
WORD = re.compile(rf"{NUMBER}[ \t]*,[ \t]*{NUMBER}[ \t]*,[ \t]*{NUMBER},?(?![^ \t])|(?:\"[^\"]*\"|[^ \t\"])+|[^ \t]+")
FRAMING = re.compile(r"\(((?:[^(),]*+,)++[^()]*+)\),?|(?<=[ \t])\|(?![^ \t])")  # of three numbers, and between fields
SEMICOLONS = re.compile(rf"(?<![^ \t])({NUMBER});({NUMBER});({NUMBER})(?![^ \t])")
# The value of an attribute that a blank parts from it, or a number from a comma; and a resolution with a comma or x.
DETACHED = re.compile(r"(?<=[ \t])([A-Za-z]\w*:(?:[^ \t]*,(?=[ \t]+[0-9.]))?)[ \t]+(?=[^ \t])(?![A-Za-z]\w*:)")
JOINED_SIZE = re.compile(r"^([ \t]*R[ \t]+[0-9]+)[,x]([0-9]+)(?![^ \t])")
DASHES = re.compile(r"(?<![^ \t])--(?![^ \t])")


class RangeError(FieldError):
    """A value that is well spelled, and that no field can take."""


class Spelling(NamedTuple):
    """The spelling of a field, the number of words that it stands for, and the sort of change, '' for none."""

    text: str
    words: int
    sort: str = ""


def split_foreign_line(line: Line) -> tuple[list[str], str, Changes] | None:
    """Return the words of a line, its comment, and what was changed; None where it has characters that are not seen, or
    too many words."""
    if first_unprintable(line) >= 0:
        return None
    body, comment, changes = body_of(line)
    found = WORD.findall(FRAMING.sub(r" \1 ", body))
    words = [word if '"' in word else "".join(word.split()) for word in found]
    changes += [(tables.JOINED, old) for old, new in zip(found, words, strict=True) if old != new]
    return (words, comment, changes) if len(words) <= MAX_WORDS else None


def body_of(line: Line) -> tuple[str, str, Changes]:
    """Return a line without its comment, the comment with its `#`, '' for none, and what was changed.

    `#F00` behind a word is a colour; `//` behind a blank, and `--` between blanks, begin a comment.
    """
    changes: Changes = []
    text = line.text
    hex_colour = HEX_COLOUR.match(text, line.end)
    if hex_colour:
        changes.append((tables.NAMED, hex_colour[0]))
        text = text[: line.end] + css_colour(hex_colour[0]) + text[hex_colour.end() :]
    text, joined = with_words_joined(text)
    changes += joined
    body, _, comment = text.partition("#")
    slashes = SLASHES.search(body) or DASHES.search(body)
    if slashes:
        changes.append((tables.SLASHES, slashes[0]))
        body, comment = text[: slashes.start()], text[slashes.end() :]
    return body, f" #{comment}" if comment else "", changes


def with_words_joined(text: str) -> tuple[str, Changes]:
    """Return a line whose words are joined as they may be meant, and what was changed."""
    body, mark, comment = text.partition("#")
    changes: Changes = []
    for pattern, words in ((SEMICOLONS, r"\1,\2,\3"), (DETACHED, r"\1"), (JOINED_SIZE, r"\1 \2")):
        changes += [(tables.JOINED, found[0]) for found in pattern.finditer(body)]
        body = pattern.sub(words, body)
    return body + mark + comment, changes


def fields_of_words(
    kind: type[Element], words: list[str], colours: Mapping[str, str], changes: Changes
) -> tuple[list[str], list[str]] | None:
    """Return the texts of the fields of an element that the first words spell, and the other words.

    `colours` are the R,G,B of named materials; `changes` gets what is not as the words say. A colour that is absent is
    white. None where a field is missing, or a number, a triple or an attribute stands in its place; RangeError for a
    value that no field can take, FieldError for a malformed word.
    """
    fields = []
    for field in positional_fields(kind):
        words = colour_first(words, colours) if isinstance(field, Colour) else words
        spelled = next(spellings(field, words, colours), None)
        has_triple = words and NUMERIC.match(words[0]) and "," in words[0]
        is_colour_absent = isinstance(field, Colour) and field.required and not has_triple
        if spelled is None and is_colour_absent:
            spelled = Spelling("255,255,255", 0, tables.WHITE)
        if spelled is None and field.required:
            of_other_field = NUMBER if isinstance(field, Three) else TRIPLE.pattern
            if words and is_well_spelled(field, words[0]):
                raise RangeError(f"its {field.title} cannot be {words[0]}")
            if words and not re.fullmatch(rf"{of_other_field}|[A-Za-z]\w*[:=].*", words[0]):
                raise FieldError(f"cannot be {quoted(words[0])}")
            return None
        if spelled is None:
            break
        if spelled.sort:
            old = " ".join(words[: spelled.words])
            changes.append((spelled.sort, f"{old}{TAKEN}{spelled.text}" if old else kind.code))
        fields.append(spelled.text)
        words = words[spelled.words :]
    return fields, words


def is_well_spelled(field: Field, text: str) -> bool:
    """Whether a text is that of a value, in range or not."""
    with suppress(FieldError):
        field.parse(text)
        return True
    return False


def colour_first(words: list[str], colours: Mapping[str, str]) -> list[str]:
    """Return the words with that of a colour before numbers and names that stand between the other fields and it."""
    if not words or words[0] in colours or css_colour(words[0]):
        return words
    index = next((index for index, word in enumerate(words) if TRIPLE.fullmatch(word)), 0)
    return [words[index], *words[:index], *words[index + 1 :]]


def spellings(field: Field, words: list[str], colours: Mapping[str, str]) -> Iterator[Spelling]:
    """Yield what the first words may mean as the value of a field."""
    for text, count, sort in readings(field, words, colours):
        with suppress(FieldError):
            value = field.parse(text)
            with suppress(FieldError):
                field.check(value)
                yield Spelling(text, count, sort)
            fitted, how = fit(field, value)
            yield Spelling(field.format(field.check(fitted)), count, how)


def readings(field: Field, words: list[str], colours: Mapping[str, str]) -> Iterator[Spelling]:
    """Yield texts that may spell the value of a field, the most likely first; they are not parsed yet.

    Each stands for one or three of the first words. `colours` are the R,G,B of named materials.
    """
    if not words:
        return
    word = words[0].strip("()[]{};,") if isinstance(field, Three) else words[0].removesuffix(",")
    yield Spelling(word, 1)
    head, _, fourth = word.rpartition(",")
    if isinstance(field, Three) and re.fullmatch(NUMBER, fourth):
        yield Spelling(head, 1, tables.FOURTH)
    if isinstance(field, Three) and "," not in "".join(words[:3]):
        yield Spelling(",".join(words[:3]), 3, tables.JOINED)
    if isinstance(field, Colour):
        if name := colours.get(word) or css_colour(word):
            yield Spelling(name, 1, tables.NAMED)
        if levels := levels_of_shares(word):
            yield Spelling(levels, 1, tables.SHARES)
        if levels := nearest_colour(word):
            yield Spelling(levels, 1, tables.NEAREST)
    if isinstance(field, Scalar) and word.count(",") == 1:
        yield Spelling(word.replace(",", "."), 1, tables.DECIMALS)


def css_colour(name: str) -> str:
    """Return R,G,B of a colour of CSS, '' for none."""
    from PIL import ImageColor

    with suppress(ValueError):
        return ",".join(map(str, ImageColor.getrgb(name)[:3]))
    return ""


def levels_of_shares(word: str) -> str:
    """Return the R,G,B from 0 to 255 of three shares from 0 to 1, of which one is no whole number; '' for others."""
    with suppress(ValueError):
        shares = [float(part) for part in word.split(",")]
        if len(shares) == 3 and min(shares) >= 0 and max(shares) <= 1 and any(each % 1 for each in shares):
            return ",".join(str(int(255 * each + 0.5)) for each in shares)
    return ""


def nearest_colour(word: str) -> str:
    """Return the whole R,G,B from 0 to 255 next to the first three of some numbers, '' for other words."""
    parts = word.split(",")[:3]
    with suppress(ValueError):
        return ",".join(str(int(clamp(float(part), 0, 255) + 0.5)) for part in parts) if len(parts) == 3 else ""
    return ""


def fit(field: Field, value: Any) -> tuple[Any, str]:
    """Return the value of a field next to one that is out of range, and what was done; FieldError where none is."""
    if isinstance(field, Direction):
        return (unit(value), SCALED) if any(value) else (field.instead, tables.NOWHERE)
    if isinstance(field, Real) and field.high == 1 and LEAST_PERCENT <= value <= 100:
        return value / 100, tables.PERCENT
    if isinstance(field, Real) or (isinstance(field, Whole) and value > field.high):
        return clamp(value, field.low, field.high), tables.NEAREST
    raise FieldError("has no value next to it")


TRIPLE = re.compile(rf"{NUMBER},{NUMBER},{NUMBER},?")
Changes = list[tuple[str, str]]  # sorts of changes, and the words that each is about
