"""minirt/README.md describes the parts, their imports and the example of a shape as they are."""

from __future__ import annotations

import re

from tests.make_tables import HELPERS, diagram, reachable
from tests.pages import blocks, read
from tests.paths import PACKAGE
from tests.test_imports import MAY, folders, graph, sources

PAGE = read("minirt/README.md")


def test_each_part_imports_only_parts_above_it() -> None:
    order: set[str] = set()
    for cell in re.findall(r"^\| (`.*?) \|", PAGE, re.MULTILINE):
        row = re.findall(r"`(\w+)`", cell)
        assert {each for part in row for each in MAY[part]} <= order | set(row), row
        order |= set(row)
    assert order == set(MAY)


def test_the_arrows_of_the_diagram_lead_to_all_imports_and_to_no_others() -> None:
    arrows: dict[str, set[str]] = {part: set() for part in MAY}
    for start, end in re.findall(r"(\w+)(?:\[\w+\])? --> (\w+)", diagram().replace("library[__init__]", "__init__")):
        arrows[start].add(end)

    def led(part: str) -> set[str]:
        return arrows[part].union(*map(led, arrows[part]))

    for part in set(MAY) - HELPERS:
        assert led(part) == reachable(part) - HELPERS, part


def test_folders_of_the_viewer_import_only_those_before_them() -> None:
    (chain,) = re.findall(r"`\w+`(?: < `\w+`)+", PAGE)
    order = [f"minirt.viewer.{name}" for name in re.findall(r"`(\w+)`", chain)]
    found = {name: wanted for name, wanted in folders(graph(sources())).items() if name in order}
    assert set(order) == {f"minirt.viewer.{path.parent.name}" for path in PACKAGE.glob("viewer/*/__init__.py")}
    for place, name in enumerate(order):
        assert found[name] & set(order) <= set(order[:place]), name


def test_its_lines_are_those_of_the_torus() -> None:
    source = (PACKAGE / "shapes/torus.py").read_text(encoding="utf-8")
    lines = [line for block in blocks("minirt/README.md", "python") if "Torus" in block for line in block.splitlines()]
    assert len(lines) > 10
    for line in lines:
        assert f"{line}\n" in source, line
