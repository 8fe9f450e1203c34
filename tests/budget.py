"""Lines and files of each part against the budget in CONTRIBUTING.md, and lines of each file: python -m tests.budget

The status is 1 where one is above. A file counts for the closest folder or pattern, and for the sum. A number is raised
in CONTRIBUTING.md, where reviewers see it.
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from pathlib import PurePosixPath

from tests.paths import ROOT

ROW = re.compile(r"^\| (`[^|]*`) \| ([\d,]+) \| ([\d,]+) \|$", re.MULTILINE)

LONGEST = 250  # lines of a file of the program


def used(folders: list[str]) -> tuple[Counter[str], Counter[str]]:
    """Return how many lines and files of Python each of these groups of folders has."""
    lines, files = Counter[str](), Counter[str]()
    for path in [*ROOT.glob("minirt/**/*.py"), *ROOT.glob("tests/**/*.py")]:
        place = PurePosixPath(path.relative_to(ROOT).as_posix())
        named = [(len(name), group) for group in folders for name in re.findall("`(.*?)`", group)
                 if place.is_relative_to(name) or place.match(name)]  # fmt: skip
        for _, group in {max(named), min(named)}:  # the sum of all, too, which is the shortest name
            lines[group] += path.read_bytes().count(b"\n")
            files[group] += 1
    return lines, files


def main() -> int:
    """Print each part with its budget; return 1 where one is above it."""
    rows = ROW.findall((ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"))
    above = 0
    lines, files = used([group for group, *_ in rows])
    for group, *numbers in rows:
        most_lines, most_files = (int(each.replace(",", "")) for each in numbers)
        is_above = lines[group] > most_lines or files[group] > most_files
        above += is_above
        figures = f"{lines[group]:>7,} of {most_lines:>6,} lines, {files[group]:>3} of {most_files:>3} files"
        print(f"{figures}  {group.replace('`', '')}{'  ABOVE THE BUDGET' * is_above}")
    for path in ROOT.glob("minirt/**/*.py"):
        if (length := path.read_bytes().count(b"\n")) > LONGEST:
            above += 1
            print(f"{length:>7,} of {LONGEST:>6,} lines  {path.relative_to(ROOT)}  TOO LONG: each file has one purpose")
    return int(above > 0)


if __name__ == "__main__":
    sys.exit(main())
