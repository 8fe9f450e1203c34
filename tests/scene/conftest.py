"""Every text that a test of this folder parses is read by both readers, the fast and the diagnosing one: they find the
same errors, and the same elements to the last bit.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain
from typing import Any
from unittest.mock import patch

import pytest

from minirt.errors import Problem, SceneError
from minirt.scene import Item, fast, parser
from minirt.scene.lines import Log
from minirt.scene.parser import read_lines

Outcome = tuple[list[Problem], list[Any], list[object] | tuple[Problem, ...]]


def no_plain_lines(sources: Sequence[str], length: int) -> Sequence[None]:
    """Stand in for `fast.read`: leave all lines to the diagnosing reader."""
    return [None] * len(sources)


def exact(item: Item) -> object:
    """Return an item's type and all of its attributes, with all bits of its numbers."""
    return item if isinstance(item, str) else (type(item), repr(vars(item)))


def outcome(sources: list[str], log: Log) -> tuple[list[Sequence[Item]], Outcome]:
    """Return the runs of items of `read_lines`, and everything by which two readers are compared."""
    try:
        runs = read_lines(sources, log)
    except SceneError as error:
        return [], (log.errors, [*log.notices], error.problems)
    told = [*log.notices, *map(repr, log.changes.items())]
    return runs, (log.errors, told, list(map(exact, chain.from_iterable(runs))))


def read_by_both(sources: list[str], log: Log) -> list[Sequence[Item]]:
    """Read lines as `read_lines` does; AssertionError when the diagnosing reader alone gives another outcome."""
    with patch.object(fast, "read", no_plain_lines):
        diagnosed = outcome(sources, Log(log.file, log.lenient))[1]
    with patch.object(fast, "FEW_LINES", 0), patch.object(fast, "MANY_LINES", 0):
        runs, both = outcome(sources, log)
    assert both == diagnosed
    if isinstance(both[2], tuple):
        raise SceneError(both[2])
    return runs


@pytest.fixture(autouse=True, scope="package")
def both_readers() -> Iterator[None]:
    """Let both readers read, and compare them."""
    with patch.object(parser, "read_lines", read_by_both):
        yield
