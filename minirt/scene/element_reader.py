"""Reader of the words of an element: which field of it each word is the value of."""

from __future__ import annotations

import re
from collections.abc import Sequence
from contextlib import suppress
from itertools import combinations, pairwise, starmap, takewhile

from minirt.element import Element, fields_by_key, fields_of, pattern, positional_fields
from minirt.errors import FieldError, hint, quoted
from minirt.fields import Colour, Field
from minirt.materials.compound import Compound
from minirt.scene.lines import Line, Log, Word
from minirt.scene.registry import ELEMENTS, OLD_NAMES, SPELLINGS, nearest_word
from minirt.scene.value_reader import Slot, parse_slots

KEY = re.compile(r"(?![A-Za-z]:[\\/])(?:(pattern:[a-z]+)(?:,|\Z)|([A-Za-z_]+):)")  # which no drive of Windows is
LEAST_LIKE = 4  # letters of a word for which a similar one is proposed that begins with another
HEX_COLOUR = re.compile(r"#(?:[0-9A-Fa-f]{6}|[0-9A-Fa-f]{3})(?![^ \t])")


def is_attribute(raw: str, keyed: dict[str, Field]) -> bool:
    """Whether a word is `key:value`, `key` or, which is wrong, `key=value`."""
    key, start = split_key(raw)
    return start > 0 or key.partition("=")[0] in keyed


def split_key(word: str) -> tuple[str, int]:
    """Return the key of an attribute, by its present name, and where its value begins: 0 where it has none."""
    match = KEY.match(word)
    key = (match[1] or match[2]) if match else word
    return OLD_NAMES.get(key, key), match.end() if match else 0


def assign_words(kind: type[Element], line_words: list[Word], line: Line, log: Log) -> list[Slot]:
    """Assign the words of a line to the fields of an element; to none, with an error, for too few or too many."""
    positional, keyed = positional_fields(kind), fields_by_key(kind)
    values = line_words[1:]
    first = next((index for index, word in enumerate(values) if is_attribute(word.text, keyed)), len(values))
    values, attributes = values[:first], values[first:]
    hex_colour = HEX_COLOUR.match(line.text, line.end)
    if len(values) < len(positional) and isinstance(positional[len(values)], Colour) and hex_colour:
        name = f"{kind.title} {positional[len(values)].title}"
        message = f"{name} must be R,G,B, got {quoted(hex_colour[0])}: '#' begins a comment"
        log.error(line, message, line.end + 1, len(hex_colour[0]))
        return []
    given = fields_given(positional, values)
    missing = [field for field in positional if field.required and field not in given]
    if missing:
        names = f"{kind.title} {' and '.join(each.title for each in missing)} {'is' if len(missing) == 1 else 'are'}"
        before = line_words[positional.index(missing[0])]
        log.error(line, f"{names} missing: expected '{pattern(kind)}'", before.end)
        attributes = [word for word in attributes if is_attribute(word.text, keyed)]
    slots = [Slot(kind, field, word) for field, word in zip(given, values, strict=False)]
    if len(values) > len(positional):
        report_extra_word(kind, slots, values[len(positional)], line, log)
        slots = []
    return slots + attribute_slots(kind, attributes, line, log)


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


def report_extra_word(kind: type[Element], slots: list[Slot], extra: Word, line: Line, log: Log) -> None:
    """Report the first wrong field of a line with too many words, or else the word `extra`."""
    before = len(log.errors)
    parse_slots(slots, line, log)
    del log.errors[before + 1 :]  # later fields may be off by one
    if len(log.errors) == before:
        keyed = fields_by_key(kind)
        guess = nearest_word(extra.text, list(keyed))
        expected = hint(keyed[guess].notation) if guess else f": expected '{pattern(kind)}'"
        why = " (one element a line)" if extra.text in SPELLINGS else expected
        log.error(line, f"{kind.title} has no further field {quoted(extra.text)}{why}", *extra.span(None))


def attribute_slots(kind: type[Element], attributes: list[Word], line: Line, log: Log) -> list[Slot]:
    """Assign the words `key:value` to fields; wrong words are reported and left out."""
    keyed = fields_by_key(kind)
    slots: dict[str, Slot] = {}
    values = dict(pairwise(attributes))
    detached = {word: value for word, value in values.items() if is_detached(word, value, keyed)}
    for word in attributes:
        if word in detached.values():
            continue
        key, start = split_key(word.text)
        written = word.text[: start - 1] if start else word.text
        field = keyed.get(key)
        if "=" in key and not start:
            right = word.text.replace("=", ":", 1)
            log.error(line, f"an attribute is written with a colon: {quoted(right)}", word.column, len(word.text))
        elif field and word in detached:
            log.error(line, f"no blank may stand behind {quoted(word.text)}", word.column, len(word.text))
        elif field and not start and not field.bare:
            message = f"{kind.title} {key} needs a value: '{field.notation}'"
            if example := initial_text(field):
                message += f", such as '{field.prefix}{example}'"
            log.error(line, message, word.column, len(word.text))
        elif not is_attribute(word.text, keyed):
            log.error(line, f"only attributes 'name:value' follow an attribute, got {quoted(word.text)}", word.column)
        elif field is None:
            log.error(line, unknown_key_message(kind, key), word.column, len(written))
        elif field.name in slots:
            log.error(line, f"{kind.title} has '{key}' twice", word.column, len(written))
        else:
            slots[field.name] = Slot(kind, field, word, start, bare=not start)
            if not word.text.startswith(key):
                message = f"'{written}' is the old name of '{field.notation}': later versions will not read it"
                log.notice(line, message, word.column, len(written))
    return list(slots.values())


def is_detached(word: Word, value: Word, keyed: dict[str, Field]) -> bool:
    """Whether a word is the value of the attribute before it, from which a blank parts it."""
    return word.text.endswith(":") and not is_attribute(value.text, keyed)


def initial_text(field: Field) -> str:
    """Return the first value of an attribute in the window, as it stands in a line; '' where it is none of numbers."""
    fields = [each for each in fields_of(field.record) if each.required] if isinstance(field, Compound) else [field]
    initial = [each.initial for each in fields]
    return ",".join(each.format(each.initial) for each in fields) if all(isinstance(n, float) for n in initial) else ""


def unknown_key_message(kind: type[Element], key: str) -> str:
    """Return the message about a key that the element does not have: the elements that have it, or a similar key."""
    keys_by_title = {other.title: fields_by_key(other) for other in ELEMENTS.values()}
    owners = dict.fromkeys(keys[key].sort or title for title, keys in keys_by_title.items() if key in keys)
    if owners:
        return f"{kind.title} has no attribute '{key}': it belongs to {', '.join(owners)}"
    names = list(fields_by_key(kind))
    guess = nearest_word(key, names)
    if len(key) < LEAST_LIKE and key[:1] != guess[:1]:
        guess = ""
    return f"unknown attribute {quoted(key)}" + (hint(guess) or f": {kind.title} has {', '.join(names) or 'none'}")
