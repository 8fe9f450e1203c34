"""Fast path of the scene reader: parse many plain lines at once.

A plain line is an identifier, all positional fields and perhaps a comment; or a comment alone, or a blank line. The
diagnosing reader (`minirt.scene.element_reader`) gives the same item for it, without errors or notices, in five times
the time.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Sequence
from functools import cache

from minirt.element import Element, cached_per_kind, positional_fields
from minirt.scene.elements import FurtherCamera
from minirt.scene.pages import Item
from minirt.scene.registry import ELEMENTS

FEW_LINES = 100  # of a file: the diagnosing reader reads them before the pattern of the fast path is compiled


@cache
def frequent_kinds() -> dict[str, type[Element]]:
    """Return the kinds that a scene may have thousands of, by identifier: for others the fast path does not pay."""
    return {
        code: kind
        for code, kind in ELEMENTS.items()
        if not kind.once and kind is not FurtherCamera and all(field.plain for field in positional_fields(kind))
    }


def line_pattern(kind: type[Element]) -> str:
    """Return the pattern of a kind's plain lines, blanks around excluded, as a group named by its identifier."""
    fields = "".join(f"[ \\t]+{field.plain}" for field in positional_fields(kind))
    return f"(?P<{kind.code}>(?:{'|'.join((kind.code, *kind.aliases))}){fields})"


@cache
def plain_line() -> re.Pattern[str]:
    """Return the pattern of all plain lines; to compile it takes as long as to diagnose 100 lines.

    No group is set by a line without an element.
    """
    elements = "|".join(map(line_pattern, frequent_kinds().values()))
    return re.compile(rf"[ \t]*+(?:(?=[#\r]|\Z)|{elements})[ \t]*+(?:#[^\r\n\0]*)?\r?")


@cached_per_kind
def plain_lines(kind: type[Element]) -> re.Pattern[str]:
    """Return the pattern of any number of plain lines of a kind, without comments."""
    return re.compile(rf"(?:[ \t]*+{line_pattern(kind)}[ \t]*+\r?\n)*+")


def read(sources: list[str], length: int) -> list[Item | None]:
    """Parse lines as they stand in a file of `length` lines; None for each that is left to the diagnosing reader."""
    if length <= FEW_LINES:
        return [None] * len(sources)
    text = "\n".join([*sources, ""])
    kind = frequent_kinds().get(text.partition(" ")[0])
    if kind and text.count("\n") == len(sources) and plain_lines(kind).fullmatch(text):
        return [*read_kind(kind, sources, sources)]  # in half the time
    lines: dict[str, list[tuple[int, str]]] = defaultdict(list)  # by identifier: indices and texts
    items: list[Item | None] = [None] * len(sources)
    match = plain_line().fullmatch
    for index, source in enumerate(sources):
        line = match(source)
        if line and line.lastgroup:
            lines[line.lastgroup].append((index, line[line.lastgroup]))
        elif line:
            items[index] = source
    for code, found in lines.items():
        indices, texts = zip(*found, strict=True)
        parsed = read_kind(frequent_kinds()[code], texts, [sources[index] for index in indices])
        for index, element in zip(indices, parsed, strict=True):
            items[index] = element
    return items


def read_kind(kind: type[Element], texts: Sequence[str], sources: list[str]) -> Sequence[Element | None]:
    """Parse plain lines of one kind; None for each with a value that is left to the diagnosing reader.

    `texts` are the lines in `sources` without their comments and the blanks around.
    """
    positional = positional_fields(kind)
    words, width = " ".join(texts).split(), 1 + len(positional)
    columns = {field.name: field.column(words[column::width]) for column, field in enumerate(positional, 1)}
    rows = zip(*columns.values(), strict=True)
    elements = kind.checked(len(sources), {"source": sources, **columns})
    accepts_all = kind.conflict is Element.conflict
    return [
        None if None in row or not (accepts_all or element.conflict() is None) else element
        for row, element in zip(rows, elements, strict=True)
    ]
