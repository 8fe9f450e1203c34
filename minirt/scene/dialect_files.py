"""A lenient reader's last look at all lines of a file: its camera, its ambient light, the conventions of its cones."""

from __future__ import annotations

import re
from typing import Any

from minirt.errors import quoted
from minirt.fields import Triple
from minirt.fields.directions import SCALED
from minirt.scene import dialect_tables as tables
from minirt.scene.dialect_fields import TRIPLE
from minirt.scene.dialect_tables import NUMBER
from minirt.scene.elements import Ambient, Camera, FurtherCamera
from minirt.scene.lines import Line, Log, line_from
from minirt.scene.registry import SHAPES
from minirt.shapes import Cone


def unread_lines(log: Log) -> int:
    """Return the number of lines that no meaning was found for, and that became comments."""
    return sum(len(log.changes.get(sort, ())) for sort in tables.UNREAD)


def complete(items: list[Any], seen: dict[str, int], log: Log) -> None:
    """Choose the camera of a file, apply conventions and add a missing ambient light: change its lines, `items`.

    `seen` has the number of a line for each identifier of the file. It gets that of a camera which is chosen here, and
    0 for an ambient light which is added here; a file without a camera gets none, as that is an error. If lines of
    shapes were not understood and no shape is left, an error goes into the log. ValueError as from
    `apply_conventions`.
    """
    promote_camera(items, seen, log)
    apply_conventions(items, log)
    unread = [*log.changes.get(tables.MISSING, ()), *log.changes.get(tables.INCOMPLETE, ())]
    if unread and not any(isinstance(item, SHAPES) for item in items):
        line, code = unread[0]
        log.error(line, f"none of the shapes can be read, of which {quoted(code)} is the first", 1, len(code))
    if Camera.code in seen and not seen.get(Ambient.code):
        seen[Ambient.code] = 0
        items.insert(0, Ambient(0.0, (255, 255, 255)))
        log.change(line_from(1, ""), tables.DARK, Ambient.code)


def promote_camera(items: list[Any], seen: dict[str, int], log: Log) -> None:
    """Let the first further camera be the camera of a file that has none, as the older subject means it."""
    index = next((index for index, item in enumerate(items) if isinstance(item, FurtherCamera)), None)
    if index is not None and Camera.code not in seen:
        first = items[index]
        source = first.source.replace(FurtherCamera.code, Camera.code, 1)
        items[index] = first.as_kind(Camera).replace(source=source)
        seen[Camera.code] = seen[first.code]
        log.change(line_from(seen[first.code], first.source), tables.RENAMED, first.code)


def apply_conventions(items: list[Any], log: Log) -> None:
    """Give cones and cameras the meaning that the words in `log.lenient` ask for: change them in `items`.

    `items` has an entry for each line of the file. In a dialect, cones without such a word get a notice that says how
    they are read. ValueError for a word that asks for nothing.
    """
    words = log.lenient.split() if isinstance(log.lenient, str) else []
    if unknown := [word for word in words if word not in tables.OPTIONS]:
        raise ValueError(f"lenient must be a bool, or some of {' '.join(tables.OPTIONS)}, got {quoted(unknown[0])}")
    is_dialect = bool(log.changes.keys() - {SCALED})
    for number, item in enumerate(items, 1):
        if not isinstance(item, Cone | Camera):
            continue
        line = line_from(number, item.source)
        table = tables.CONES if isinstance(item, Cone) else tables.CAMERAS
        meant = [word for word in table if word in words]
        if is_dialect and isinstance(item, Cone) and not meant:
            log.change(line, tables.APEX, item.code)
        for word in meant:
            log.change(line, tables.CONVENTION.format(item.plural, tables.OPTIONS[word]), item.code)
            before, written = items[number - 1], direction_as_written(line, log)
            try:
                items[number - 1] = before.replace(**table[word](before, written))
            except ValueError as error:
                log.error(line, f"{error} ({tables.OPTIONS[word]})", 1)


def direction_as_written(line: Line, log: Log) -> Triple:
    """Return the second three numbers of a line, before they were scaled to a direction."""
    scaled = (words for each, words in log.changes.get(SCALED, ()) if each.number == line.number)
    text = next(scaled, "") or TRIPLE.findall(line.text)[1]
    x, y, z = map(float, re.findall(NUMBER, text)[:3])
    return x, y, z
