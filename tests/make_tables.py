"""Write the generated parts of the documentation anew: python -m tests.make_tables

A table stands between `<!-- table: NAME -->` and `<!-- end -->` of a page. The text for package indexes stands in
pyproject.toml; the manual page is a file of its own.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from pathlib import Path

from minirt.viewer import keys_markdown
from tests.format_table import format_table
from tests.manual_page import PAGE, manual_page
from tests.pages import PAGES, block, name, read
from tests.paths import ROOT, SCENES
from tests.test_imports import MAY

# Left out of the diagram, as small.
HELPERS = {"errors", "records", "helpers", "formats", "image", "movie", "example_scenes", "__main__"}
PLACE = re.compile(r"(<!-- table: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)
INDEX_TEXT = re.compile(r"^(text = '''\n).*?^(''')$", re.MULTILINE | re.DOTALL)
PICTURE = re.compile(r"^\| !\[.*?\]\((.*?)\) \| .*?<br>`miniRT (\S+)(.*)$", re.MULTILINE)


def reachable(part: str) -> set[str]:
    """All parts that a part may import, itself or by way of others."""
    return MAY[part].union(*map(reachable, MAY[part]))


def diagram() -> str:
    """Imports of the parts as a Mermaid diagram, without arrows that follow from others."""
    lines = ["```mermaid", "graph TD"]
    for part in MAY:
        below = reachable(part) - HELPERS
        implied = set().union(*map(reachable, below))
        if part not in HELPERS:
            lines += [f"    {node(part)} --> {node(other)}" for other in MAY if other in below - implied]
    return "\n".join([*lines, "```"])


def node(part: str) -> str:
    """A part in the diagram."""
    return "library[__init__]" if part == "__init__" else part


def gallery(rows: str) -> str:
    """Rows of the gallery with the first line of each scene as caption; commands and times as they are."""

    def captioned(row: re.Match[str]) -> str:
        picture, scene, rest = row.groups()
        caption = (SCENES.parent / scene).read_text(encoding="utf-8").splitlines()[0].removeprefix("# ")
        return f"| ![{caption}]({picture}) | {caption}<br>`miniRT {scene}{rest}"

    return PICTURE.sub(captioned, rows)


TABLES: dict[str, Callable[[], str]] = {"keys": keys_markdown, "elements": format_table, "diagram": diagram}


def renewed(page: str) -> str:
    """The text of a page with its tables as the program generates them."""

    def table(place: re.Match[str]) -> str:
        start, named, end = place.groups()
        make = partial(gallery, place.group()[len(start) : -len(end)]) if named == "gallery" else TABLES[named]
        return f"{start}\n{make().strip()}\n\n{end}"

    return PLACE.sub(table, page)


def index_text() -> str:
    """README.md as package indexes show it: the introduction and the Python example, without links and pictures.

    The project has no public address to which links and pictures could lead.
    """
    introduction = read("README.md").partition("## Install")[0].strip().split("\n\n")
    shown = [each for each in introduction if "](" not in each and not each.startswith("(")]
    return "\n\n".join([*shown, "## In Python", f"```python\n{block('README.md', 'python', 'minirt.load')}```\n"])


def with_index_text(project: str) -> str:
    """The text of pyproject.toml with `index_text`."""
    return INDEX_TEXT.sub(lambda place: f"{place[1]}{index_text()}{place[2]}", project)


def write(path: Path, text: str) -> None:
    """Write a file if its text has changed, and print its name."""
    if path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
        print(path.relative_to(ROOT))


def main() -> None:
    """Write every file whose generated parts have changed."""
    for page in PAGES:
        write(page, renewed(read(name(page))))
    write(ROOT / "pyproject.toml", with_index_text(read("pyproject.toml")))
    write(PAGE, manual_page())


if __name__ == "__main__":
    main()
