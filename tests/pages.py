"""Pages of documentation as tests read them: their code blocks, tables, links and names of files."""

from __future__ import annotations

import re
from pathlib import Path

from tests.paths import PACKAGE, ROOT

FOLDERS = ("minirt", "scenes", "tests", "assets")
PAGES = sorted([*ROOT.glob("*.md"), *(page for folder in FOLDERS for page in (ROOT / folder).rglob("*.md"))])


def name(page: Path) -> str:
    """Path of a page from the top folder."""
    return page.relative_to(ROOT).as_posix()


def read(page: str) -> str:
    """Text of a page, by its path from the top folder."""
    return (ROOT / page).read_text(encoding="utf-8")


def blocks(page: str, language: str) -> list[str]:
    """Code blocks of a page in a language; indented ones without their indentation."""
    found = re.findall(r"^( *)```(\w*)\n(.*?)^ *```$", read(page), re.MULTILINE | re.DOTALL)
    return [re.sub(f"^{indent}", "", text, flags=re.MULTILINE) for indent, named, text in found if named == language]


def block(page: str, language: str, words: str) -> str:
    """The one code block of a page that contains these words."""
    (text,) = (each for each in blocks(page, language) if words in each)
    return text


def programs() -> list[tuple[str, str]]:
    """Pages and their Python blocks, without those that quote a source of the package."""
    sources = [list(map(str.strip, read(name(file)).splitlines())) for file in PACKAGE.rglob("*.py")]
    found = [(name(page), text) for page in PAGES for text in blocks(name(page), "python")]
    return [(page, text) for page, text in found if not any(quotes(text, source) for source in sources)]


def quotes(text: str, source: list[str]) -> bool:
    """Whether the lines of a block all stand in a source, in the same order; others may stand between them."""
    rest = iter(source)
    return all(line.strip() in rest for line in text.splitlines())


def links(page: str) -> list[str]:
    """Targets of the links and pictures of a page."""
    return re.findall(r"\]\(([^)\s]+)\)", without_code(read(page)))


def without_code(text: str) -> str:
    """A page without its code blocks."""
    return re.sub(r"^ *```.*?^ *```$", "", text, flags=re.MULTILINE | re.DOTALL)


def anchors(page: str) -> set[str]:
    """Names by which links refer to the headings of a page, as GitHub and GitLab make them."""
    headings = re.findall(r"^#+ (.*)$", without_code(read(page)), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}
