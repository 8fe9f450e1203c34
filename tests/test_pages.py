"""The pages of the documentation agree with the program: links, names of files, generated parts, commands and code."""

from __future__ import annotations

import re
import shutil
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

from minirt.cli import main
from minirt.cli.arguments import argument_parser
from tests.make_tables import PAGE, index_text, manual_page, renewed
from tests.pages import PAGES, anchors, block, blocks, links, name, programs, read, without_code
from tests.paths import PACKAGE, ROOT, TESTS
from tests.processes import run
from tests.skipping import require
from tests.typed.stubs import stubs

NAMES = [name(page) for page in PAGES]
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
FILE = re.compile(r"`([\w./-]+\.(?:py|md|rt|cpp|txt)|\.ci/run)`")
NO_FILES = {"scene.rt", "scene.recovered.rt", "report.md", "DIR/report.md", "keys.txt"}  # examples; what miniRT writes
GENERATED = "write it anew: python -m tests.make_tables"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder to run code in, with the scenes."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scenes").symlink_to(ROOT / "scenes")
    return tmp_path


def broken_links(page: str) -> Iterator[str]:
    """Yield the links of a page that lead to no file or heading."""
    for target in links(page):
        file, _, heading = target.partition("#")
        path = ((ROOT / page).parent / file).resolve() if file else ROOT / page
        if not path.is_file() or not path.is_relative_to(ROOT) or (heading and heading not in anchors(name(path))):
            yield target


def missing_files(page: str) -> Iterator[str]:
    """Yield the names of files on a page that are nowhere."""
    folders = ((ROOT / page).parent, ROOT, PACKAGE, TESTS)
    for file in FILE.findall(without_code(read(page))):
        if file not in NO_FILES and not any((folder / file).is_file() for folder in folders):
            yield file


def unknown_commands(page: str) -> Iterator[str]:
    """Yield the targets of make, and the commands with options, that do not exist."""
    (targets,) = re.findall(r"^\.PHONY: (.*)$", MAKEFILE, re.MULTILINE)
    known = " ".join(argument_parser().format_help().split())
    code = "\n".join(blocks(page, "sh") + re.findall(r"`([^`\n]+)`", without_code(read(page))))
    yield from (each for each in re.findall(r"^make ([a-z-]+)", code, re.MULTILINE) if each not in targets.split())
    for command in re.findall(r"\bminiRT (.*?)(?:  #|$)", code, re.MULTILINE):
        options = re.findall(r"(?:^| )(--?[a-z-]+)", command)
        if not all(re.search(rf"(?:^|[\s\[,|]){re.escape(option)}\b", known) for option in options):
            yield command


@pytest.mark.parametrize("wrong", [broken_links, missing_files, unknown_commands])
def test_what_pages_name_exists(wrong) -> None:
    assert not {page: found for page in NAMES if (found := list(wrong(page)))}


def test_the_makefile_makes_the_program_by_default_and_names_files_that_exist() -> None:
    assert re.findall(r"^(\w+):", MAKEFILE, re.MULTILINE)[0] == "all"
    assert re.search(r"^all: \$\(NAME\)", MAKEFILE, re.MULTILINE)
    named = re.findall(r"\btests/[\w/]+\.py\b", MAKEFILE)
    assert len(named) > 5
    assert [path for path in named if not (ROOT / path).is_file()] == []


@pytest.mark.parametrize(
    ("tests", "compiles"),
    [
        ("", True),
        ("tests/kernel", True),
        ("tests/shapes tests/fuzz", True),
        ("tests/shapes tests/stability/test_starts.py", False),
    ],
)
def test_make_compiles_kernels_only_for_tests_that_run_them(tests: str, compiles: bool) -> None:
    told = run(["make", "--dry-run", "--always-make", "test", f"TESTS={tests}"], cwd=ROOT, text=True).stdout
    assert re.search(rf"-m pytest .*{tests}$", told, re.MULTILINE)
    assert bool(re.search(r"-m minirt\.rendering\.ahead_of_time$", told, re.MULTILINE)) is compiles


def test_generated_parts_are_as_generated() -> None:
    assert not [page for page in NAMES if renewed(read(page)) != read(page)], GENERATED
    assert tomllib.loads(read("pyproject.toml"))["project"]["readme"]["text"] == index_text(), GENERATED
    for path, text in {PAGE: manual_page(), **stubs()}.items():
        assert path.read_text(encoding="utf-8") == text, GENERATED


def test_the_manual_page_has_the_whole_help_of_each_option() -> None:
    shown = PAGE.read_text(encoding="utf-8").replace("\\-", "-").replace("\\(aq", "'").lower()
    helps = [action.help or "" for action in argument_parser()._actions if action.option_strings]
    assert [text for text in helps if f"\n{text.lower()}" not in shown] == []


def test_roff_shows_the_manual_page_without_a_warning() -> None:
    groff = shutil.which("groff")
    if not groff:
        pytest.skip("no groff")
    done = run([groff, "-man", "-Tascii", "-ww", "-P-c", "-rHY=0"], PAGE.read_text(encoding="utf-8"), text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert "EXIT STATUS" in re.sub(".\b", "", done.stdout)


# Runs a file as the main module, in a process that spawns others as macOS and Windows do. Its windows are simulated,
# and their user presses Escape.
SPAWNING = """
import multiprocessing, runpy, sys
from minirt.mlx import Key, api
from minirt.mlx.memory import Memory

def screen():
    memory = Memory()
    memory.press(Key.ESCAPE)
    memory.release(Key.ESCAPE)
    return memory

api._pyglet_display = screen
multiprocessing.set_start_method("spawn")
runpy.run_path(sys.argv[1], run_name="__main__")
"""
PROGRAMS = programs()


@pytest.mark.parametrize(("page", "program"), PROGRAMS, ids=[f"{page}-{n}" for n, (page, _) in enumerate(PROGRAMS)])
def test_each_python_block_runs_alone_and_writes_what_it_names(page: str, program: str, folder: Path) -> None:
    if "notebook=True" in program:
        require("anywidget")
    (folder / "program.py").write_text(program, encoding="utf-8")
    done = run([sys.executable, "-W", "error", "-c", SPAWNING, "program.py"], text=True)
    assert (done.returncode, done.stderr) == (0, ""), f"a block of {page}"
    written = re.findall(r'(?:save|save_movie|render_to)\(.*?"(\w+\.\w+)"', program)
    assert all((folder / each).stat().st_size > 100 for each in written)


def test_blocks_that_only_quote_sources_are_few() -> None:
    quoted = sum(len(blocks(page, "python")) for page in NAMES) - len(PROGRAMS)
    assert 0 < quoted <= 6 < len(PROGRAMS)


def test_the_scene_is_read_and_the_errors_are_printed_as_shown(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for beginning in ("A 0.2", "A 0.3"):
        (folder / "scene.rt").write_text(block("scenes/README.md", "", beginning))
        assert main(["scene.rt", "--check"]) == 0
        assert capsys.readouterr().err == ""
    errors = block("scenes/README.md", "", "Error\n")
    wrong = re.findall(r"^    (s.*)$", errors, re.MULTILINE)
    (folder / "scene.rt").write_text("\n".join(["A 0.2 255,255,255", "C 0,2,-12 0,-0.1,1 60", "", *wrong]))
    capsys.readouterr()
    assert main(["scene.rt"]) == 1
    assert capsys.readouterr().err == errors


def test_the_recorded_keys_are_played(folder: Path) -> None:
    (folder / "scene.rt").write_bytes((ROOT / "scenes/eval-sphere.rt").read_bytes())  # the keys save it
    (folder / "keys.txt").write_text(block("minirt/viewer/README.md", "", "press Tab"))
    assert main(["scene.rt", "--replay", "keys.txt", "-o", "out.png"]) == 0
    assert (folder / "out.png").exists()
