"""Every page of the documentation agrees with the program: its links, its file names, its tables and its commands."""

from __future__ import annotations

import re

import pytest

from minirt.cli.arguments import argument_parser
from tests.make_tables import renewed
from tests.pages import PAGES, anchors, blocks, links, name, read, without_code
from tests.paths import PACKAGE, ROOT, TESTS

NAMES = [name(page) for page in PAGES]
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
FILE = re.compile(r"`([\w./-]+\.(?:py|md|rt|cpp|txt)|\.ci/run)`")
NO_FILES = {
    "scene.rt",
    "scene.recovered.rt",
    "report.md",
    "DIR/report.md",
    "keys.txt",
}  # examples, and files that miniRT writes


def test_all_pages_are_here() -> None:
    assert {
        "README.md",
        "CONTRIBUTING.md",
        "SECURITY.md",
        "CHANGELOG.md",
        "scenes/README.md",
        "minirt/README.md",
        "minirt/viewer/README.md",
        "minirt/rendering/README.md",
        "minirt/cli/README.md",
        "minirt/mlx/README.md",
        "minirt/report/README.md",
        "tests/README.md",
        "tests/bench/README.md",
        "tests/stability/README.md",
    } <= set(NAMES)


@pytest.mark.parametrize("page", NAMES)
def test_the_readme_links_every_page(page: str) -> None:
    assert page == "README.md" or page in links("README.md")


@pytest.mark.parametrize("page", NAMES)
def test_links_lead_to_files_and_headings(page: str) -> None:
    for target in links(page):
        file, _, heading = target.partition("#")
        path = ((ROOT / page).parent / file).resolve() if file else ROOT / page
        assert path.is_file(), target
        assert path.is_relative_to(ROOT), target
        assert not heading or heading in anchors(name(path)), target


@pytest.mark.parametrize("page", NAMES)
def test_files_that_a_page_names_exist(page: str) -> None:
    folders = ((ROOT / page).parent, ROOT, PACKAGE, TESTS)
    for file in FILE.findall(without_code(read(page))):
        assert file in NO_FILES or any((folder / file).is_file() for folder in folders), file


@pytest.mark.parametrize("page", NAMES)
def test_tables_are_as_generated(page: str) -> None:
    assert renewed(read(page)) == read(page), "write them anew: python -m tests.make_tables"


@pytest.mark.parametrize("page", NAMES)
def test_targets_of_make_exist(page: str) -> None:
    (targets,) = re.findall(r"^\.PHONY: (.*)$", MAKEFILE, re.MULTILINE)
    code = "\n".join(blocks(page, "sh") + re.findall(r"`(make [^`]*)`", read(page)))
    for target in re.findall(r"^make ([a-z-]+)", code, re.MULTILINE):
        assert target in targets.split(), target


@pytest.mark.parametrize("page", NAMES)
def test_options_of_the_program_exist(page: str) -> None:
    known = " ".join(argument_parser().format_help().split())
    code = "\n".join(blocks(page, "sh") + re.findall(r"`([^`\n]+)`", without_code(read(page))))
    for command in re.findall(r"\bminiRT (.*?)(?:  #|$)", code, re.MULTILINE):
        for option in re.findall(r"(?:^| )(--?[a-z-]+)", command):
            assert re.search(rf"(?:^|[\s\[,|]){re.escape(option)}\b", known), command


@pytest.mark.parametrize("page", NAMES)
def test_pages_name_no_private_place(page: str) -> None:
    """Neither addresses that are not there for everybody nor folders of one machine."""
    assert not re.findall(r"https?://|localhost|/home/|/tmp/", read(page))


def test_a_broken_page_is_found() -> None:
    stale = "<!-- table: keys -->\n\n| action | keys |\n\n<!-- end -->\n"
    assert renewed(stale) != stale
    assert FILE.findall("`kernel/no_such.py` and `.ci/run`") == ["kernel/no_such.py", ".ci/run"]
