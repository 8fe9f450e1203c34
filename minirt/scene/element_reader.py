"""From a line of a scene file to an element, in four steps: cut it into words, identify the element, assign the words
to its fields, fill the fields with values.
"""

from __future__ import annotations

import re
from typing import Any, NamedTuple

from minirt.element import Element, cached_per_kind, fields_of, pattern
from minirt.errors import FieldError, FileError, quoted
from minirt.fields import Colour, Field, MeshFile
from minirt.fields.numerals import code_point_name
from minirt.scene.diagnostics import Log
from minirt.scene.lines import Line, Word, joined, words
from minirt.scene.registry import ELEMENTS, SPELLINGS
from minirt.scene.suggestions import GLUED, NUMERIC, hint, nearest_element, nearest_key

SLASHES = re.compile(r"(?<![^ \t])//")
COMMA_AND_BLANK = re.compile(r"[ \t],|,[ \t]")
KEY = re.compile(r"([A-Za-z_]+):")
HEX_COLOUR = re.compile(r"#(?:[0-9A-Fa-f]{6}|[0-9A-Fa-f]{3})(?![^ \t])")


class Slot(NamedTuple):
    """A word that is the value of a field."""

    field: Field
    word: Word
    start: int = 0  # index of the value in the word: behind `key:`
    bare: bool = False  # whether the word is the key alone

    @property
    def text(self) -> str:
        """What spells the value."""
        return self.field.bare if self.bare else self.word.text[self.start :]

    def place(self, part: int | None) -> tuple[int, int]:
        """Column and length of a component of the value, or of it all."""
        return self.word.place(part, self.start)


class Table(NamedTuple):
    """The fields of an element as a line has them."""

    placed: tuple[Field, ...]
    keyed: dict[str, Field]  # by all keys
    needed: int  # how many of those with a place must be given


@cached_per_kind
def table(kind: type[Element]) -> Table:
    """The fields of a kind of element."""
    placed = tuple(field for field in fields_of(kind) if not field.keyed)
    keyed = {key: field for field in fields_of(kind) if field.keyed for key in field.keys}
    return Table(placed, keyed, sum(field.required for field in placed))


def is_attribute(raw: str, keyed: dict[str, Field]) -> bool:
    """Whether a word begins with a key, or is one that may stand alone."""
    return bool(KEY.match(raw)) or (raw in keyed and bool(keyed[raw].bare))


def cut(line: Line, log: Log) -> list[Word] | None:
    """The words of a line, none for a comment or a blank line; None where it cannot be cut into words."""
    body = line.text[: line.end]
    if "\r" in line.text or not body.replace("\t", " ").isprintable():
        column, odd = next(
            (column, character)
            for column, character in enumerate(line.text, 1)
            if character == "\r" or (column <= len(body) and character != "\t" and not character.isprintable())
        )
        lone = "a carriage return ends a line only together with a line feed"
        log.error(
            line, column, lone if odd == "\r" else f"only spaces and tabs separate fields, got {code_point_name(odd)}"
        )
        return None
    slashes = SLASHES.search(body) if "//" in body else None
    if slashes:
        if not log.tolerate(line, slashes.start() + 1, "a comment begins with '#', got '//'", "takes '//', too", 2):
            return None
        body = body[: slashes.start()]
    apart = words(body)
    blank = COMMA_AND_BLANK.search(body, apart[1].column - 1) if len(apart) > 1 else None
    if blank:
        together = joined(apart, body)
        message = "no blanks may stand around a comma"
        if len(together) < len(apart) and not log.tolerate(line, blank.start() + 1, message, "leaves them out", 2):
            return None
        return together
    return apart


def identify(word: Word, line: Line, log: Log) -> str | None:
    """The identifier that `word` is or stands for. None where it is none; `log` then says what it may mean."""
    code = word.raw
    if code in SPELLINGS:
        return SPELLINGS[code].code
    glued = GLUED.match(code)
    if glued and glued[1] in SPELLINGS:
        log.error(line, word.column + len(glued[1]), f"a blank is missing after '{glued[1]}'")
    elif NUMERIC.match(code):
        known = ", ".join(ELEMENTS)
        log.error(line, word.column, f"a line begins with one of {known}, got {quoted(code)}", len(code))
    else:
        guess = nearest_element(code)
        log.error(line, word.column, f"unknown element {quoted(code)}{hint(guess)}", len(code))
    return None


def assign(kind: type[Element], line_words: list[Word], line: Line, log: Log) -> list[Slot] | None:
    """Which of the words is the value of which field; None where there are too few or too many."""
    placed, keyed, needed = table(kind)
    given = line_words[1:]
    first = next((index for index, word in enumerate(given) if is_attribute(word.raw, keyed)), len(given))
    given, keys = given[:first], given[first:]
    hex_colour = HEX_COLOUR.match(line.text, line.end)
    if len(given) < len(placed) and isinstance(placed[len(given)], Colour) and hex_colour:
        name = f"{kind.title} {placed[len(given)].title}"
        message = f"{name} must be R,G,B, got {quoted(hex_colour[0])}: '#' begins a comment"
        log.error(line, line.end + 1, message, len(hex_colour[0]))
        return None
    if len(given) < needed:
        missing = " and ".join(field.title for field in placed[len(given) : needed])
        verb = "is" if needed - len(given) == 1 else "are"
        column = line_words[len(given)].end
        log.error(line, column, f"{kind.title} {missing} {verb} missing: expected '{pattern(kind)}'")
        return None
    slots = [Slot(field, word) for field, word in zip(placed, given, strict=False)]
    if len(given) > len(placed):
        blame(kind, slots, given[len(placed)], line, log)
        return None
    return slots + attributes(kind, keys, line, log) if keys else slots


def blame(kind: type[Element], slots: list[Slot], extra: Word, line: Line, log: Log) -> None:
    """Says what is wrong with a line that has the word `extra` too many: the first wrong field, or else that word."""
    before = len(log.errors)
    fill(kind, slots, line, log)
    del log.errors[before + 1 :]  # behind the first all fields may be off by one
    if len(log.errors) == before:
        why = " (one element a line)" if extra.raw in SPELLINGS else instead(kind, extra.raw)
        log.error(line, extra.column, f"{kind.title} has no further field {quoted(extra.raw)}{why}", len(extra.raw))


def instead(kind: type[Element], word: str) -> str:
    """What may be meant by a word too many."""
    keyed = table(kind).keyed
    guess = nearest_key(word, list(keyed))
    return hint(keyed[guess].notation) if guess else f": expected '{pattern(kind)}'"


def attributes(kind: type[Element], keys: list[Word], line: Line, log: Log) -> list[Slot]:
    """The words `key:value` behind the other fields, those left out that are wrong."""
    keyed = table(kind).keyed
    slots: dict[str, Slot] = {}
    for word in keys:
        match = KEY.match(word.raw)
        key = match[1] if match else word.raw
        field = keyed.get(key)
        if not is_attribute(word.raw, keyed):
            log.error(line, word.column, f"only attributes 'name:value' follow an attribute, got {quoted(word.raw)}")
        elif field is None:
            log.error(line, word.column, unknown_key(kind, key), len(key))
        elif field.name in slots:
            log.error(line, word.column, f"{kind.title} has '{field.keys[0]}' twice", len(key))
        else:
            slots[field.name] = Slot(field, word, match.end() if match else 0, bare=match is None)
    return list(slots.values())


def unknown_key(kind: type[Element], key: str) -> str:
    """What is wrong with an attribute that the element does not have."""
    keyed = {other.title: table(other).keyed for other in ELEMENTS.values()}
    owners = dict.fromkeys(keys[key].sort or title for title, keys in keyed.items() if key in keys)
    if owners:
        return f"{kind.title} has no attribute '{key}': it belongs to {', '.join(owners)}"
    own = table(kind).keyed
    guess = nearest_key(key, list(own)) or nearest_key(key, [each for keys in keyed.values() for each in keys])
    names = dict.fromkeys(field.keys[0] for field in own.values())
    return f"unknown attribute {quoted(key)}" + (hint(guess) or f": {kind.title} has {', '.join(names) or 'none'}")


def fill(kind: type[Element], slots: list[Slot], line: Line, log: Log) -> dict[str, Any] | None:
    """The values of the fields by name; None where one is wrong."""
    values = {slot.field.name: value_of(slot, kind, line, log) for slot in slots}
    return None if None in values.values() else values


def value_of(slot: Slot, kind: type[Element], line: Line, log: Log) -> Any:
    """The value of one field, None where it is wrong."""
    field, word, text = slot.field, slot.word, slot.text
    try:
        value = field.parse(text)
        checked = field.check(value)
        remark = field.remark(value)
    except FieldError as error:
        column, length = slot.place(error.part)
        message = f"{kind.title} {field.title} {error}"
        # Of four components with blanks between them the last may as well be the next field.
        repaired = repair(field, text) if word.raw == word.text or text.count(",") == 2 else None
        if repaired is None:
            log.error(line, column, message, length)
            return None
        checked, deeds = repaired
        return checked if log.tolerate(line, column, message, deeds, length) else None
    if remark:
        column, length = slot.place(None)
        log.notice(line, column, f"{kind.title} {field.title} {remark}", length)
    return with_files(slot, checked, kind, line, log)


def with_files(slot: Slot, value: Any, kind: type[Element], line: Line, log: Log) -> Any:
    """The value with the mesh that it names; None where a file that it names cannot be used."""
    if log.folder is None:
        return value
    errors = len(log.errors)
    if isinstance(value, MeshFile):
        from minirt.meshes import mesh  # with numpy, which few scenes need this early

        try:
            return MeshFile(value.name, mesh(log.folder / value.name))
        except FileError as error:
            column, length = slot.place(None)
            message = f"must be a mesh file, got {quoted(value.name)}: {error.reason}"
            log.error(line, column, f"{kind.title} {slot.field.title} {message}", length)
            return None
    for name, heights, part in slot.field.pictures(value):
        from minirt.materials import picture_cache

        try:
            (picture_cache.heights if heights else picture_cache.picture)(log.folder / name)
        except FileError as error:
            column, length = slot.place(part)
            message = f"must be a picture file, got {quoted(name)}: {error.reason}"
            log.error(line, column, f"{kind.title} {slot.field.title} {message}", length)
    return value if len(log.errors) == errors else None


def repair(field: Field, text: str) -> tuple[Any, str] | None:
    """What a lenient reader takes for a wrong spelling, and how; None where there is nothing to take."""
    deeds = []
    while repaired := field.repair(text):
        text, deed = repaired
        deeds.append(deed)
        try:
            return field.check(field.parse(text)), " and ".join(deeds)
        except FieldError:
            continue
    return None
