"""Dialects of other programs: a lenient reader translates a line that it cannot read into one that it can.

Words fill the fields of the element in turn, as far as they can be meant for them; what other words mean stands in
`minirt.scene.dialect_tables`, and those without a meaning are left out. What was done is told once for each sort of
change, with its places.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

from minirt.element import Element, fields_by_key, positional_fields
from minirt.errors import FieldError, FileError, Problem
from minirt.fields import Three
from minirt.helpers import file_io
from minirt.materials import pictures
from minirt.scene import dialect_tables as tables
from minirt.scene.attribute_reader import split_key
from minirt.scene.dialect_fields import TRIPLE, Changes, RangeError, fields_of_words, split_foreign_line
from minirt.scene.dialect_tables import NUMBER
from minirt.scene.elements import FURTHER, LAMPS, Ambient, Background, Camera, FurtherCamera, Light, Resolution
from minirt.scene.line_reader import read_line
from minirt.scene.lines import TAKEN, Line, Log, line_from
from minirt.scene.pages import Item
from minirt.scene.registry import SHAPES, SPELLINGS
from minirt.scene.scene import MISSING

LIGHT, SETTING = (re.compile(pattern, re.IGNORECASE) for pattern in (tables.LIGHT, tables.SETTING))
MOST_NUMBERS = 2  # behind the fields of a shape, whose meaning is guessed


class Translation(NamedTuple):
    """A line of the format, "" for none, and the sorts of changes that led to it, with the words that each is about."""

    text: str
    changes: Iterable[tuple[str, str]]


def colours_of_materials(sources: list[str]) -> dict[str, str]:
    """Return the R,G,B of named materials, from the lines of a file that begin as settings: `mat red 255,0,0 ...`."""
    found = {}
    for source in sources:
        code, name, *values = [*source.split()[:12], "", ""]
        colour = next(filter(TRIPLE.fullmatch, values), "")
        if colour and SETTING.fullmatch(code) and code not in SPELLINGS:
            found[name] = colour.rstrip(",")
    return found


def translated(
    line: Line, colours: Mapping[str, str], folder: Path | None, seen: Mapping[str, int] | None = None
) -> Translation | None:
    """Return the translation of a line; its text is '' where the line is no element that is known here.

    None where the line stays an error, as for an ambient light or a camera without which there is no picture. `colours`
    are the R,G,B of named materials, and pictures are looked for in `folder`. The keys of `seen` are the identifiers of
    earlier lines.
    """
    split = split_foreign_line(line)
    if split is None:
        return None
    words, comment, changes = split
    if not words:
        return Translation("", changes)
    code, *values = words
    kind = kind_of(code)
    if kind is None:
        # An unknown word with a point, direction or colour is taken for a shape; the face of a mesh has none of these.
        has_triple = len(values) > 1 and any(map(TRIPLE.fullmatch, values))
        is_shape = code == tables.FACE or (has_triple and not SETTING.fullmatch(code))
        unread = tables.LIGHTS if LIGHT.fullmatch(code) else tables.MISSING
        return Translation("", [(unread if is_shape else tables.SETTINGS, code)])
    is_second = kind.code in (seen or ())
    kind = FURTHER.get(kind, kind) if is_second else kind
    if kind is not SPELLINGS.get(code):  # it becomes an element of another name
        is_repeated = is_second and code in (Camera.code, Light.code)
        changes.append((tables.SECOND if is_repeated else tables.RENAMED, f"{code}{TAKEN}{kind.code}"))
    ordered = in_order(kind.code, values)
    if ordered != values:
        changes.append((tables.ORDER, code))
    try:
        spelled = fields_of_words(kind, ordered, colours, changes)
    except FieldError as error:
        is_missing = kind in SHAPES and isinstance(error, RangeError)
        told = (tables.INCOMPLETE, f"{code} ({error})") if is_missing else (tables.SETTINGS, code)
        return Translation("", [told]) if is_missing or kind in (Resolution, FurtherCamera) else None
    if spelled is None:
        unread = tables.INCOMPLETE if kind in SHAPES else tables.LIGHTS if kind in LAMPS else tables.SETTINGS
        return Translation("", [(unread, code)]) if kind not in (Ambient, Camera) else None
    fields, others = spelled
    attributes = meanings(kind, others, folder, changes)
    return Translation(" ".join([kind.code, *fields, *attributes]) + comment, changes)


def without_element(line: Line, errors: list[Problem]) -> Translation | None:
    """Leave out a line that is well spelled but for `errors`, such as a file that is absent: that of a shape, or of a
    background under another name. None for others, whose errors stay."""
    code = line.text.split()[0]
    reason = errors[0].message.rpartition(": ")[2]
    if kind_of(code) in SHAPES:
        return Translation("", [(tables.MISSING, f"{code} ({reason})")])
    is_foreign = kind_of(code) is Background and code != Background.code
    return Translation("", [(tables.SETTINGS, code)]) if is_foreign else None


def kind_of(code: str) -> type[Element] | None:
    """Return the kind of element that a line begins with; three letters of its name are enough."""
    lower = code.lower()
    known = next(filter(None, map(SPELLINGS.get, (code, tables.CODES.get(lower, ""), lower, code.upper()))), None)
    named = (kind for kind in SPELLINGS.values() if len(code) > 2 and kind.title.startswith(lower))
    return known or next(named, None)


def in_order(code: str, words: list[str]) -> list[str]:
    """Return the words of an element in the order of its fields here.

    The words are in a known order of another program, or they are as many numbers and triples as the fields, in another
    order: then each field takes the next number or triple. The latter holds for shapes, and for elements with one
    number. Other words stay as they are.
    """
    # A letter for each word: v for a triple, n for a number, w for another word.
    letters = "".join("v" if TRIPLE.fullmatch(word) else "n" if re.fullmatch(NUMBER, word) else "w" for word in words)
    fitting = (means for kind, pattern, means in tables.LAYOUTS if kind == code and re.match(pattern, letters))
    known = next((means(*words) for means in fitting), words)
    kind = SPELLINGS[code]
    wanted = "".join("v" if isinstance(field, Three) else "n" for field in positional_fields(kind))
    given = letters[: len(wanted)]
    is_clear = kind in SHAPES or wanted.count("n") == 1
    has_known_order, has_same_words = known is not words, sorted(given) == sorted(wanted)
    if has_known_order or not is_clear or given == wanted or not has_same_words:
        return known
    triples, numbers = (iter([word for word, of in zip(words, given, strict=False) if of == sort]) for sort in "vn")
    return [*(next(triples if sort == "v" else numbers) for sort in wanted), *words[len(wanted) :]]


def meanings(kind: type[Element], words: list[str], folder: Path | None, changes: Changes) -> list[str]:
    """Return the attributes that words behind the fields mean; `changes` gets each word that is not one as it stands.

    The files that attributes name are tried, from `folder`, that of the scene; without one they are not tried.
    """
    keyed = fields_by_key(kind)
    has_colour = tables.WHITE not in dict(changes)  # without one a number names a material
    are_guessed = has_colour and sum(re.fullmatch(NUMBER, word) is not None for word in words) <= MOST_NUMBERS
    found: dict[str, str] = {}

    def add(attribute: str) -> str:
        """Add an attribute to those that were `found`, and return ''; or return why it is none, a sort of change."""
        key, start = split_key(attribute)
        try:
            if (field := keyed.get(key)) is None or key in found:
                return tables.LEFT_OUT
            value = field.check(field.parse(attribute[start:] if start else field.bare))
            for file in field.pictures(value):
                if folder:
                    pictures.reader(file)(file_io.located(folder, file.name))
        except (FieldError, FileError) as error:
            return tables.ABSENT if isinstance(error, FileError) else tables.LEFT_OUT
        found[key] = attribute
        return ""

    while words:
        used, attributes, sort = 1, "", ""
        if add(words[0].replace("=", ":", 1)):
            used, attributes, sort = meaning(words, are_guessed)
            attributes = attributes.replace(tables.USUAL, getattr(keyed.get("checker"), "bare", ""))
        sort = next(filter(None, map(add, attributes.split())), sort)
        if sort:
            changes.append((sort, " ".join(words[:used])))
        words = words[used:]
    return list(found.values())


def meaning(words: list[str], are_guessed: bool) -> tuple[int, str, str]:
    """Return how many of the first words mean something together, the attributes, and the sort of change.

    Numbers alone have one only where they `are_guessed`.
    """
    for used in (2, 1):
        text = " ".join(words[:used])
        for pattern, means, sort in tables.ROWS if len(words) >= used else ():
            match = re.fullmatch(pattern, text, re.IGNORECASE)
            if match and (are_guessed or sort not in tables.GUESSES):
                attributes = means(*match.groups())
                return used, attributes, sort if attributes else tables.LEFT_OUT
    return 1, "", tables.LEFT_OUT


def read_leniently(line: Line, seen: dict[str, int], log: Log, colours: Mapping[str, str]) -> Item | None:
    """Return the item of any line, translated from another program where it cannot be read as it stands.

    None after an error. A line without a meaning here becomes a comment. `seen` gets its identifier, if it is read;
    `colours` are the R,G,B of named materials. What was changed goes into the log.
    """
    known, before, notices = dict(seen), len(log.errors), len(log.notices)  # to go back to before a second attempt
    item = read_line(line, seen, log)
    translation = None if item is not None else translated(line, colours, log.folder, known)
    if translation is None:
        return item
    errors = log.errors[before:]
    del log.errors[before:], log.notices[notices:]
    seen.clear()
    seen.update(known)
    if translation.text:
        item = read_line(line_from(line.number, translation.text), seen, log)
        unread = log.errors[before:]
        if item is None and (translation := without_element(line, unread)) is None:
            log.errors[before:] = errors
            return None
        del log.errors[before:]
    for sort, words in translation.changes:
        log.change(line, sort, words)
    is_missing = {tables.MISSING, tables.INCOMPLETE}.intersection(dict(translation.changes))
    return item or f"{MISSING if is_missing else '# '}{line.text}"
