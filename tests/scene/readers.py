"""The reader of plain lines against the careful one: whatever is read is read by both, to the last bit."""

from __future__ import annotations

from collections.abc import Sequence
from unittest.mock import patch

from minirt.errors import Problem, SceneError
from minirt.scene import Item, fast
from minirt.scene.diagnostics import Log
from minirt.scene.parser import read_lines

Outcome = tuple[list[Problem], list[Problem], list[object] | tuple[Problem, ...]]


def none_plain(sources: Sequence[str]) -> Sequence[None]:
    """What `plain.read` would say if no line were plain."""
    return [None] * len(sources)


def exactly(item: Item) -> object:
    """An item with its type, its source and all bits of its numbers."""
    return item if isinstance(item, str) else (type(item), repr(vars(item)))


def outcome(sources: list[str], log: Log) -> tuple[list[Item], Outcome]:
    """What `read_lines` gives, and all that can be told of it."""
    try:
        items = read_lines(sources, log)
    except SceneError as error:
        return [], (log.errors, log.notices, error.problems)
    return items, (log.errors, log.notices, list(map(exactly, items)))


def read_by_both(sources: list[str], log: Log) -> list[Item]:
    """Like `read_lines`; AssertionError where the careful reader alone tells another story."""
    with patch.object(fast, "read", none_plain):
        careful = outcome(sources, Log(log.file, log.lenient))[1]
    items, quick = outcome(sources, log)
    assert quick == careful
    if isinstance(quick[2], tuple):
        raise SceneError(quick[2])
    return items
