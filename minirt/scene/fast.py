"""Fast path of the scene reader: parse many plain lines at once.

A plain line is an identifier, all positional fields, and perhaps attributes and a comment; or a comment alone, or a
blank line. The diagnosing reader (`minirt.scene.line_reader`) gives the same item for it, without errors or notices,
in a hundred times the time. Its numbers are read by compiled code (`minirt.kernel.plain_lines`), and its attributes,
which many lines share, once.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache, lru_cache
from typing import Any

import numpy as np

from minirt.element import Element, fields_by_key, positional_fields
from minirt.kernel.plain_lines import BEHIND_COMMA, MOST, NAME, NOTHING, NUMBER, OTHER, WHOLE
from minirt.scene.attribute_reader import attribute_slots
from minirt.scene.elements import FurtherCamera
from minirt.scene.lines import Log, line_from, split_line
from minirt.scene.pages import Crowd, Item
from minirt.scene.registry import SPELLINGS
from minirt.scene.value_reader import parse_slots, tell_useless

FEW_LINES = 100  # of a file: the diagnosing reader reads them before compiled code is loaded
MANY_LINES = 100_000  # of a file: where there is no compiled code, compiling it takes less time than diagnosing them

READ = "minirt.kernel.plain_lines:read_lines"


@cache
def forms() -> tuple[list[type[Element]], np.ndarray]:
    """Return the n forms of lines that are read: the kind of element of each, and a table of them for the kernel.

    A row of the table, (n, `NAME` + `MOST`), is the bytes of an identifier and then, for each number behind it, bits
    that tell whether it is whole and whether a comma precedes it. A kind has a form for each of its identifiers. Kinds
    are those that a scene may have thousands of, of which all positional fields are numbers.
    """
    kinds: list[type[Element]] = []
    table = np.zeros((len(SPELLINGS), NAME + MOST), np.int8)
    for name, kind in SPELLINGS.items():
        fields = positional_fields(kind)
        if not kind.once and kind is not FurtherCamera and all(field.number for field in fields):
            parts = [(field.number is int, part > 0) for field in fields for part in range(field.width)]
            wholes = [WHOLE if is_whole else 0 for is_whole, _ in parts]
            commas = [BEHIND_COMMA if is_behind else 0 for _, is_behind in parts]
            bits = [NUMBER | whole | comma for whole, comma in zip(wholes, commas, strict=True)]
            table[len(kinds), : NAME + len(bits)] = [*name.encode().ljust(NAME, b"\0"), *bits]
            kinds.append(kind)
    return kinds, table[: len(kinds)]


def call_for(text: bytes, lines: int) -> tuple[str, tuple[np.ndarray, ...]]:
    """Return the call of the kernel for so many lines, with memory for what is in them."""
    kinds, numbers = np.empty(lines, np.int64), np.empty(lines * MOST)
    inexact = np.empty((len(text) // 2 + 1, 3), np.int64)
    return READ, (np.frombuffer(text, np.int8), forms()[1], kinds, numbers, inexact)


def read(sources: list[str], length: int) -> Sequence[Item | None]:
    """Return the items of lines of a file that has `length` lines; None for each that is left to the diagnosing reader.

    If all lines are elements of one kind, the items are a `Crowd`. A short file is left to the diagnosing reader, and
    so is one of less than `MANY_LINES` lines where there is no compiled code.
    """
    items: list[Item | None] = [None] * len(sources)
    if length <= FEW_LINES:
        return items
    from minirt.kernel.machine_code.library import LIBRARY  # which takes 40 ms

    attributes = attributes_of(sources)
    plain = [*sources, ""]
    for line, ending in attributes.items():
        plain[line] = sources[line][: -len(ending)]
    text = "\n".join(plain).encode("utf-8", "surrogatepass")
    call = call_for(text, len(sources))
    if length < MANY_LINES and not LIBRARY.has(LIBRARY.identity(call)):
        return items
    _, arguments = call
    LIBRARY.get(call)(*arguments)
    _, _, of_lines, numbers, inexact = arguments  # `of_lines`: the index of each line's form
    count = int(np.argmax(inexact[:, 0] < 0))
    end_of_lines = inexact[count, 1]
    if end_of_lines < len(text):  # one of the sources has a line feed
        return items
    for index, first, end in inexact[:count].tolist():
        numbers[index] = float(text[first:end]) + 0.0  # -0 becomes 0
    numbers, (kinds, _) = numbers.reshape(-1, MOST), forms()
    present = set(of_lines.tolist()) - {OTHER, NOTHING}
    found = [read_kind(kinds[form], sources, numbers, np.flatnonzero(of_lines == form)) for form in present]
    for _, crowd in found:
        if len(crowd) == len(sources) and not attributes:
            return crowd
    for line in {*np.flatnonzero(of_lines == NOTHING).tolist()} - attributes.keys():
        items[line] = sources[line]
    for lines, crowd in found:
        kind: Any = crowd.kind
        for line, element in zip(lines.tolist(), crowd, strict=True):
            ending = attributes.get(line, "").removesuffix("\r").partition("#")[0]
            values = values_of(kind, ending)
            for name, value in (values or {}).items():
                object.__setattr__(element, name, value)
            items[line] = None if values is None else element
    return items


def attributes_of(sources: list[str]) -> dict[int, str]:
    """Return the ends of lines from their first attribute with a value on, by the indices of the lines; not of a line
    with a carriage return before its end, which the diagnosing reader refuses even in a comment."""
    plain = ((line, source) for line, source in enumerate(sources) if ":" in source and "\r" not in source[:-1])
    befores = ((line, source, source.partition(":")[0]) for line, source in plain)
    return {line: source[before.rfind(" ") + 1 :] for line, source, before in befores if "#" not in before}


@lru_cache(maxsize=4096)
def values_of(kind: type[Element], attributes: str) -> dict[str, Any] | None:
    """Return the values of the attributes of a line, by the names of their fields; None where the diagnosing reader has
    to say something about them, or has to try a file."""
    log = Log("", lenient=False)
    line = line_from(0, f"{kind.code} 0 {attributes}")
    words = (split_line(line, log) or [])[2:]
    slots = attribute_slots(kind, fields_by_key(kind), words, line, log)
    values = parse_slots(slots, line, log)
    (element,) = kind.of_columns(1, {name: [value] for name, value in values.items()})
    tell_useless(element, slots, line, log)
    is_told = log.errors or log.notices or log.changes
    has_files = any(any(slot.field.pictures(values[slot.field.name])) for slot in slots if not is_told)
    return None if is_told or has_files else values


def read_kind(
    kind: type[Element], sources: list[str], numbers: np.ndarray, lines: np.ndarray
) -> tuple[np.ndarray, Crowd]:
    """Return the indices of the lines that are elements of a kind, (k,), and these elements.

    `lines` are the indices in `sources` of the lines that begin as this kind does; `numbers` (n, `MOST`) has a row for
    each of all sources. Elements whose fields are out of range or in conflict are left out.
    """
    columns, start = {}, 0
    fields: Any = positional_fields(kind)
    for field in fields:
        columns[field.name] = numbers[lines, start : start + field.width]
        start += field.width
    crowd = Crowd(kind, [sources[line] for line in lines.tolist()], columns)
    in_range = np.flatnonzero(np.logical_and.reduce([field.fits(columns[field.name]) for field in fields]))
    if kind.conflict is not Element.conflict:
        has_conflict = [element.conflict() is not None for element in crowd.some(in_range)]
        in_range = np.delete(in_range, np.flatnonzero(has_conflict))
    return lines[in_range], crowd.some(in_range)
