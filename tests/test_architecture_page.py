"""What minirt/README.md tells those who change miniRT is so."""

from __future__ import annotations

import re
from pathlib import Path

from tests.paths import PACKAGE
from tests.test_imports import MAY

PAGE = (PACKAGE / "README.md").read_text()


def test_each_part_imports_only_parts_above_it() -> None:
    order: set[str] = set()
    for cell in re.findall(r"^\| (`.*?) \|", PAGE, re.MULTILINE):
        row = re.findall(r"`(\w+)`", cell)
        assert {each for part in row for each in MAY[part]} <= order | set(row), row
        order |= set(row)
    assert order == set(MAY)


def test_all_files_that_it_names_are_there() -> None:
    root = Path(PACKAGE).parent
    for name in re.findall(r"`([\w/]+\.py)`", PAGE):
        assert (PACKAGE / name).is_file() or (root / name).is_file(), name


def test_its_lines_are_those_of_the_torus() -> None:
    source = (PACKAGE / "shapes/torus.py").read_text()
    blocks = re.findall(r"^   ```python\n(.*?)^   ```$", PAGE, re.MULTILINE | re.DOTALL)
    lines = [line[3:] for block in blocks for line in block.splitlines()]
    assert len(lines) > 10
    for line in lines:
        assert f"{line}\n" in source, line
