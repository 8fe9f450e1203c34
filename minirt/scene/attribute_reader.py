"""Reader of attributes, the words `key:value` of a line: which field of the element each one gives."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import pairwise

from minirt.element import Element, fields_by_key
from minirt.errors import hint, quoted
from minirt.fields import Field
from minirt.scene.lines import Line, Log, Word
from minirt.scene.registry import ELEMENTS, OLD_NAMES, nearest_word
from minirt.scene.value_reader import Slot

KEY = re.compile(r"(?![A-Za-z]:[\\/])(?:(pattern:[a-z]+)(?:,|\Z)|([A-Za-z_]+):)")  # which no drive of Windows is
LEAST_LIKE = 4  # letters of a word for which a similar one is proposed that begins with another


def is_attribute(raw: str, keyed: Mapping[str, Field]) -> bool:
    """Whether a word is `key:value`, `key` or, which is wrong, `key=value`."""
    key, start = split_key(raw)
    return start > 0 or key.partition("=")[0] in keyed


def split_key(word: str) -> tuple[str, int]:
    """Return the key of an attribute, by its present name, and where its value begins: 0 where it has none."""
    match = KEY.match(word)
    key = (match[1] or match[2]) if match else word
    return OLD_NAMES.get(key, key), match.end() if match else 0


def attribute_slots(
    kind: type[Element], keyed: Mapping[str, Field], attributes: list[Word], line: Line, log: Log
) -> list[Slot]:
    """Return the fields that the words `attributes` give, each with its word; errors go into the log.

    Wrong words are left out. An old name of an attribute gets a notice. `keyed` are the attributes of the element by
    their keys: its `fields_by_key`.
    """
    slots: dict[str, Slot] = {}
    # Words such as `texture:`, and the next word, which a blank parts from its key: one error is enough for both.
    detached = {word: value for word, value in pairwise(attributes) if is_detached(word, value, keyed)}
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
            if field.example:
                message += f", such as '{field.prefix}{field.example}'"
            log.error(line, message, word.column, len(word.text))
        elif not is_attribute(word.text, keyed):
            log.error(line, f"only attributes 'name:value' follow an attribute, got {quoted(word.text)}", word.column)
        elif field is None:
            log.error(line, unknown_key_message(kind, keyed, key), word.column, len(written))
        elif field.name in slots:
            log.error(line, f"{kind.title} has '{key}' twice", word.column, len(written))
        else:
            slots[field.name] = Slot(kind, field, word, start, bare=not start)
            if not word.text.startswith(key):
                message = f"'{written}' is the old name of '{field.notation}': later versions will not read it"
                log.notice(line, message, word.column, len(written))
    return list(slots.values())


def is_detached(word: Word, value: Word, keyed: Mapping[str, Field]) -> bool:
    """Whether a word is the value of the attribute before it, from which a blank parts it."""
    return word.text.endswith(":") and not is_attribute(value.text, keyed)


def unknown_key_message(kind: type[Element], keyed: Mapping[str, Field], key: str) -> str:
    """Return the message about a key that the element does not have: the elements that have it, or a similar key."""
    keys_by_title = {other.title: fields_by_key(other) for other in ELEMENTS.values()}
    owners = dict.fromkeys(keys[key].sort or title for title, keys in keys_by_title.items() if key in keys)
    if owners:
        return f"{kind.title} has no attribute '{key}': it belongs to {', '.join(owners)}"
    names = list(keyed)
    guess = nearest_word(key, names)
    if len(key) < LEAST_LIKE and key[:1] != guess[:1]:
        guess = ""
    return f"unknown attribute {quoted(key)}" + (hint(guess) or f": {kind.title} has {', '.join(names) or 'none'}")
