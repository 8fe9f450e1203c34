"""Diagnosing reader of one line of a scene file: every error is logged with its column and a hint.

A line goes one way: it is split into words (`minirt.scene.lines`), the first word names an element
(`minirt.scene.registry`), the others are assigned to its fields here and in `minirt.scene.attribute_reader`, and their
values are parsed (`minirt.scene.value_reader`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from itertools import combinations, compress, starmap, takewhile
from typing import Any

from minirt.element import Element, fields_by_key, pattern, positional_fields
from minirt.errors import FieldError, hint, quoted
from minirt.fields import Colour, Field
from minirt.scene.attribute_reader import attribute_slots, is_attribute
from minirt.scene.lines import HEX_COLOUR, Line, Log, Word, split_line
from minirt.scene.pages import Item
from minirt.scene.registry import SPELLINGS, identify, nearest_element, nearest_word
from minirt.scene.value_reader import Slot, parse_slots, tell_useless


def read_line(line: Line, seen: dict[str, int], log: Log) -> Item | None:
    """Read any line: an element, or the line itself for a comment or a blank line; None after an error.

    `seen` has the first line of each identifier, and gets that of this line.
    """
    words = split_line(line, log)
    if words == []:
        return line.source
    kind = identify(words[0], line, log) if words else None
    if not words or not kind:
        seen.setdefault(nearest_element((line.text.split() or [""])[0]), line.number)
        return None
    return read_element(kind, words, seen.setdefault(kind.code, line.number), line, log)


def read_element(kind: type[Element], words: list[Word], first: int, line: Line, log: Log) -> Element | None:
    """Return the element of a line, of this kind; None after an error, which goes into the log.

    `words` are those of the line, `first` is the number of the first line with the same identifier.
    """
    errors = len(log.errors)
    if kind.once and first != line.number:
        message = f"a second {kind.title}: the first is in line {first}, and there may be one"
        log.error(line, message, *words[0].span(None))
    slots, values = read_values(kind, words, line, log)
    if len(log.errors) > errors:
        return None
    (element,) = kind.of_columns(1, {"source": [line.source], **{name: [value] for name, value in values.items()}})
    conflict = element.conflict()
    if conflict is None:
        tell_useless(element, slots, line, log)
        return element
    name, message = conflict
    slot = next(slot for slot in slots if slot.field.name == name)
    log.error(line, f"{kind.title} {name} {message}", *slot.span(None))
    return None


def read_values(kind: type[Element], words: list[Word], line: Line, log: Log) -> tuple[list[Slot], dict[str, Any]]:
    """Return the fields that a line gives, each with its word, and their values by name; errors go into the log.

    Positional fields come first, attributes follow. Where '#' seems to begin a colour, that is the only error, and
    there are neither.
    """
    positional, keyed = positional_fields(kind), fields_by_key(kind)
    are_attributes = [is_attribute(word.text, keyed) for word in words[1:]]
    count = (*are_attributes, True).index(True)
    given, attributes = words[1 : 1 + count], words[1 + count :]
    following = positional[len(given)] if len(given) < len(positional) else None
    hex_colour = HEX_COLOUR.match(line.text, line.end)
    if hex_colour and isinstance(following, Colour):
        message = f"must be R,G,B, got {quoted(hex_colour[0])}: '#' begins a comment"
        log.error(line, f"{kind.title} {following.title} {message}", line.end + 1, len(hex_colour[0]))
        return [], {}
    fields = fields_given(positional, given)
    missing = [field for field in positional if field.required and field not in fields]
    if missing:
        names = f"{kind.title} {' and '.join(each.title for each in missing)} {'is' if len(missing) == 1 else 'are'}"
        before = words[positional.index(missing[0])]
        log.error(line, f"{names} missing: expected '{pattern(kind)}'", before.end)
        attributes = [*compress(words[1:], are_attributes)]  # also those between positional words
    slots = [Slot(kind, field, word) for field, word in zip(fields, given, strict=False)]
    further = attribute_slots(kind, keyed, attributes, line, log)
    errors = len(log.errors)
    values = parse_slots(slots, line, log)
    extra = given[len(positional) :]
    if extra:
        del log.errors[errors + 1 :]  # the first wrong field alone: later ones may be off by one
    has_wrong_field = len(log.errors) > errors
    values |= parse_slots(further, line, log)
    if extra and not has_wrong_field:
        report_extra_word(kind, keyed, extra[0], line, log)
    return slots + further, values


def fields_given(positional: Sequence[Field], words: list[Word]) -> list[Field]:
    """Return the fields that the words of a line seem to be meant for, where there are fewer words than fields."""
    if len(words) >= sum(field.required for field in positional):
        return list(positional[: len(words)])
    for fits in (is_value_of, has_parts_of):
        for fields in combinations(positional, len(words)):
            if all(starmap(fits, zip(fields, words, strict=True))):
                return list(fields)
    return [field for field, _ in takewhile(lambda pair: has_parts_of(*pair), zip(positional, words, strict=False))]


def is_value_of(field: Field, word: Word) -> bool:
    """Whether a word is the value of a field."""
    with suppress(FieldError):
        return has_parts_of(field, word) and field.check(field.parse(word.text)) is not None
    return False


def has_parts_of(field: Field, word: Word) -> bool:
    """Whether a word has as many numbers as a field."""
    return word.text.count(",") == field.width - 1


def report_extra_word(kind: type[Element], keyed: Mapping[str, Field], extra: Word, line: Line, log: Log) -> None:
    """Report the first word behind the fields of a line; `keyed` are the element's attributes by their keys."""
    guess = nearest_word(extra.text, list(keyed))
    expected = hint(keyed[guess].notation) if guess else f": expected '{pattern(kind)}'"
    why = " (one element a line)" if extra.text in SPELLINGS else expected
    log.error(line, f"{kind.title} has no further field {quoted(extra.text)}{why}", *extra.span(None))
