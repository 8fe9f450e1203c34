"""From an element to its line in a scene file, with no more changed of the line than changed of the element."""

from __future__ import annotations

from typing import Any

from minirt.element import Element, fields_of
from minirt.fields import Field
from minirt.scene.diagnostics import Log
from minirt.scene.element_reader import Slot, assign_words, identify, parse_slots, split_line
from minirt.scene.lines import Word, line_from
from minirt.scene.registry import ELEMENTS, SPELLINGS


def describe(element: Element) -> str:
    """The element as a line of a scene file, without regard to how it was written there."""
    fields = fields_of(type(element))
    written = [field for field in fields if not field.keyed or getattr(element, field.name) != field.default]
    return " ".join([element.code, *(field_text(field, element) for field in written)])


def field_text(field: Field, element: Element) -> str:
    """A field of the element as it is written in a line."""
    value = field.format(getattr(element, field.name))
    return f"{field.keys[0]}:{value}" if field.keyed else value


def line_of(element: Element) -> str:
    """The element's source line where that still says the same, else with the changed fields in it, else a new one."""
    kind = type(element)
    line = line_from(1, element.source)
    log = Log("", lenient=True)
    words = split_line(line, log) if not {"\n", "\0"} & set(line.source) else None
    code = identify(words[0], line, log) if words else None
    # A further light may come from a second `L`, and is a kind of it.
    slots = assign_words(kind, words, line, log) if words and code and isinstance(element, ELEMENTS[code]) else None
    values = parse_slots(kind, slots, line, log) if slots else None
    if not words or not slots or not values or log.errors:
        return describe(element)
    if all(getattr(element, field.name) == values.get(field.name, field.default) for field in fields_of(kind)):
        return line.source
    before, _, behind = line.source.partition(line.text)
    return before + rewritten(line.text, element, words, slots, values) + behind


def rewritten(text: str, element: Element, words: list[Word], slots: list[Slot], values: dict[str, Any]) -> str:
    """The line `text`, whose fields have `values` in `slots`, with the fields of the element in it."""
    unwritten = [field for field in fields_of(type(element)) if field.name not in values]
    different = [field for field in unwritten if getattr(element, field.name) != field.default]
    # From the back to the front: what is done leaves the columns of the rest as they were.
    for field in reversed(different):
        if field.keyed:
            text = insert(text, words[-1].end, field_text(field, element))
    by_column = sorted(slots, key=lambda slot: slot.word.column, reverse=True)
    for slot in by_column:
        if slot.field.keyed:
            text = rewrite_slot(text, slot, element, values)
    if not all(field.keyed for field in different):
        last = max(slot.word.end for slot in slots if not slot.field.keyed)
        text = insert(text, last, " ".join(field_text(field, element) for field in unwritten if not field.keyed))
    for slot in by_column:
        if not slot.field.keyed:
            text = rewrite_slot(text, slot, element, values)
    code = words[0].raw if SPELLINGS[words[0].raw] is type(element) else element.code
    return replace_span(text, words[0].column, words[0].end, code)


def insert(text: str, column: int, new: str) -> str:
    """`text` with `new` and a blank in front of it at `column`."""
    return f"{text[: column - 1]} {new}{text[column - 1 :]}"


def rewrite_slot(text: str, slot: Slot, element: Element, values: dict[str, Any]) -> str:
    """`text` with the element's value in the slot, where it is another than that of `values`."""
    value = getattr(element, slot.field.name)
    if value == values[slot.field.name]:
        return text
    if value is None:
        return text[: slot.word.column - 1].rstrip(" \t") + text[slot.word.end - 1 :]
    if slot.bare:
        return replace_span(text, slot.word.column, slot.word.end, field_text(slot.field, element))
    return replace_span(text, slot.word.column + slot.start, slot.word.end, slot.field.format(value))


def replace_span(text: str, start: int, end: int, new: str) -> str:
    """`text` with `new` from column `start` to `end`; where several spaces follow, the next word keeps its column."""
    rest = text[end - 1 :]
    following = rest.lstrip(" ")
    gap = len(rest) - len(following)
    if gap > 1 and following:
        gap = max(1, gap - (len(new) - (end - start)))
    return text[: start - 1] + new + " " * gap + following
