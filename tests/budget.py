"""Lines and files of each part against the budget in CONTRIBUTING.md: python -m tests.budget

The status is 1 where one is above. A file counts for the closest folder or pattern, and for the sum. A number is raised
in CONTRIBUTING.md, where reviewers see it.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import PurePosixPath
from typing import NamedTuple

from tests.paths import ROOT

ROW = re.compile(r"^\| (`[^|]*`) \| ([\d,]+) \| ([\d,]+) \|$", re.MULTILINE)


class Part(NamedTuple):
    """Folders, and how many lines and files of Python they may have."""

    folders: tuple[str, ...]
    lines: int
    files: int


def budget(page: str) -> list[Part]:
    """Read the table of a page."""
    rows = ROW.findall(page)
    return [
        Part(tuple(re.findall("`(.*?)`", row[0])), *(int(each.replace(",", "")) for each in row[1:])) for row in rows
    ]


def sources() -> Iterator[tuple[PurePosixPath, int]]:
    """Yield every source of the program and of the tests with the number of its lines."""
    for path in sorted([*ROOT.glob("minirt/**/*.py"), *ROOT.glob("tests/**/*.py")]):
        yield PurePosixPath(path.relative_to(ROOT).as_posix()), path.read_bytes().count(b"\n")


def used(parts: list[Part]) -> list[Part]:
    """Return how many lines and files each part has."""
    totals = {part.folders: [0, 0] for part in parts}
    for path, lines in sources():
        named = [(name, part.folders) for part in parts for name in part.folders]
        names = [(len(name), part) for name, part in named if path.is_relative_to(name) or path.match(name)]
        for _, folders in {max(names), min(names)}:  # the sum of all, too, which is the shortest name
            totals[folders][0] += lines
            totals[folders][1] += 1
    return [Part(folders, *total) for folders, total in totals.items()]


def main() -> int:
    """Print each part with its budget; return 1 where one is above it."""
    parts = budget((ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"))
    above = 0
    for part, found in zip(parts, used(parts), strict=True):
        is_above = found.lines > part.lines or found.files > part.files
        above += is_above
        figures = f"{found.lines:>7,} of {part.lines:>6,} lines, {found.files:>3} of {part.files:>3} files"
        print(f"{figures}  {' '.join(part.folders)}{'  ABOVE THE BUDGET' * is_above}")
    return int(above > 0)


if __name__ == "__main__":
    sys.exit(main())
