"""Changes of host code that no test can notice, each with its reason: `explained_changes.toml`."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import NamedTuple

LIST = Path(__file__).with_name("explained_changes.toml")


class Explanation(NamedTuple):
    """Changes that may survive: the file in the package, the text of the line, what becomes what, and why."""

    file: str
    line: str
    changes: list[str]
    reason: str


@cache
def explanations() -> tuple[Explanation, ...]:
    """Return all explanations."""
    return tuple(Explanation(**each) for each in tomllib.loads(LIST.read_text(encoding="utf-8"))["explained"])


def is_explained(file: Path, line: str, change: str) -> bool:
    """Whether the list names a change."""
    return any((each.file, each.line) == (file.as_posix(), line) and change in each.changes for each in explanations())
