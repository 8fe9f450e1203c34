"""Diagnosing reader of one line of a scene file: every error is logged with its column and a hint.

It works in four steps: split the line into words, identify the element, assign words to fields
(`minirt.scene.element_reader`), parse their values (`minirt.scene.value_reader`).
"""

from __future__ import annotations

import re

from minirt.element import Element
from minirt.errors import hint, quoted
from minirt.fields.scalars import code_point_name
from minirt.scene.element_reader import assign_words
from minirt.scene.lines import Line, Log, Word, first_unprintable, words_of
from minirt.scene.pages import Item
from minirt.scene.registry import ELEMENTS, GLUED, NUMERIC, SPELLINGS, nearest_element
from minirt.scene.value_reader import parse_slots, tell_useless

SLASHES = re.compile(r"(?<![^ \t])//")


def read_line(line: Line, seen: dict[str, int], log: Log) -> Item | None:
    """Read any line: an element, or the line itself for a comment or a blank line; None after an error."""
    words = split_line(line, log)
    if words == []:
        return line.source
    kind = identify(words[0], line, log) if words else None
    if not words or not kind:
        seen.setdefault(nearest_element((line.text.split() or [""])[0]), line.number)
        return None
    return read_element(kind, words, seen.setdefault(kind.code, line.number), line, log)


def read_element(kind: type[Element], words: list[Word], first: int, line: Line, log: Log) -> Element | None:
    """Read the element of a line; None after an error. `first` is the first line with the same identifier."""
    errors = len(log.errors)
    if kind.once and first != line.number:
        message = f"a second {kind.title}: the first is in line {first}, and there may be one"
        log.error(line, message, *words[0].span(None))
    slots = assign_words(kind, words, line, log)
    values = parse_slots(slots, line, log)
    if len(log.errors) > errors:
        return None
    (element,) = kind.checked(1, {"source": [line.source], **{name: [value] for name, value in values.items()}})
    conflict = element.conflict()
    if conflict is None:
        tell_useless(element, slots, line, log)
        return element
    name, message = conflict
    slot = next(slot for slot in slots if slot.field.name == name)
    log.error(line, f"{kind.title} {name} {message}", *slot.span(None))
    return None


def split_line(line: Line, log: Log) -> list[Word] | None:
    """Return the words of a line, none for a comment or a blank line; None after an error."""
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
    blank = next((word.column - 1 for word in words[2:] if word.text.startswith(",")), 0)
    blank = blank or next((word.end - 1 for word in words[1:-1] if word.text.endswith(",")), 0)
    if slashes:
        log.error(line, "a comment begins with '#', got '//'", slashes.start() + 1, 2)
    elif blank:
        log.error(line, "no blanks may stand around a comma", blank, 2)
    return None if slashes or blank else words


def identify(word: Word, line: Line, log: Log) -> type[Element] | None:
    """Return the element whose identifier `word` is; None, with an error and a hint, for none."""
    code = word.text
    if code in SPELLINGS:
        return SPELLINGS[code]
    glued = GLUED.match(code)
    if glued and glued[1] in SPELLINGS:
        log.error(line, f"a blank is missing after '{glued[1]}'", word.column + len(glued[1]))
        return None
    message = f"unknown element {quoted(code)}{hint(nearest_element(code))}"
    if NUMERIC.match(code):
        message = f"a line begins with one of {', '.join(ELEMENTS)}, got {quoted(code)}"
    log.error(line, message, word.column, len(code))
    return None
