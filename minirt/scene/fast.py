"""Reads plain lines, many at once: an identifier, all fields that have a place, perhaps a comment, nothing else.

For such a line the careful reader (`reading`) has the same element and nothing to say. It takes five times as long.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Sequence

from minirt.element import Element, fields_of
from minirt.scene.registry import ELEMENTS

# Of what may be there once there is not enough for the detour.
KINDS = {
    code: kind
    for code, kind in ELEMENTS.items()
    if not kind.once and all(field.plain for field in fields_of(kind) if not field.keyed)
}


def line_pattern(kind: type[Element]) -> str:
    """The regular expression of an element's plain lines without blanks around, in a group that is named like it."""
    fields = "".join(f"[ \\t]+{field.plain}" for field in fields_of(kind) if not field.keyed)
    return f"(?P<{kind.code}>(?:{'|'.join((kind.code, *kind.aliases))}){fields})"


LINE = re.compile(rf"[ \t]*(?:{'|'.join(map(line_pattern, KINDS.values()))})[ \t]*(?:#[^\r\n\0]*)?\r?")


def read(sources: Sequence[str]) -> Sequence[Element | None]:
    """The elements of lines as they stand in a file; None for each line that the careful reader must read."""
    places: dict[str, list[int]] = defaultdict(list)
    texts: dict[str, list[str]] = defaultdict(list)
    for place, source in enumerate(sources):
        line = LINE.fullmatch(source)
        if line:
            code = line.lastgroup or ""
            places[code].append(place)
            texts[code].append(line[code])
    elements: list[Element | None] = [None] * len(sources)
    for code, lines in places.items():
        found = read_kind(KINDS[code], texts[code], [sources[place] for place in lines])
        for place, element in zip(lines, found, strict=True):
            elements[place] = element
    return elements


def read_kind(kind: type[Element], texts: list[str], sources: list[str]) -> Sequence[Element | None]:
    """The elements of one kind that are in those lines; None for each with a value that calls for the careful reader.

    `texts` are the lines without blanks and comments around.
    """
    placed = [field for field in fields_of(kind) if not field.keyed]
    words, width = " ".join(texts).split(), 1 + len(placed)
    columns = {field.name: field.column(words[at::width]) for at, field in enumerate(placed, 1)}
    rows = zip(*columns.values(), strict=True)
    elements = kind.checked(len(sources), {"source": sources, **columns})
    good = [None if None in row else element for row, element in zip(rows, elements, strict=True)]
    if kind.conflict is not Element.conflict:
        good = [None if element is None or element.conflict() else element for element in good]
    return good
