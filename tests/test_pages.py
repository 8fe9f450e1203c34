"""The pages of the documentation agree with the program: links, names of files, generated parts, commands and code."""

from __future__ import annotations

import re
import shutil
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

import minirt
from minirt.cli import main
from minirt.cli.arguments import argument_parser
from tests.make_tables import PAGE, index_text, manual_page, renewed
from tests.pages import PAGES, anchors, block, blocks, links, name, read, without_code
from tests.paths import PACKAGE, ROOT, TESTS
from tests.processes import run
from tests.skipping import require

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


def test_generated_parts_are_as_generated() -> None:
    assert not [page for page in NAMES if renewed(read(page)) != read(page)], GENERATED
    assert tomllib.loads(read("pyproject.toml"))["project"]["readme"]["text"] == index_text(), GENERATED
    assert PAGE.read_text(encoding="utf-8") == manual_page(), GENERATED


def test_roff_shows_the_manual_page_without_a_warning() -> None:
    groff = shutil.which("groff")
    if not groff:
        pytest.skip("no groff")
    done = run([groff, "-man", "-Tascii", "-ww", "-P-c", "-rHY=0"], PAGE.read_text(encoding="utf-8"), text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert "EXIT STATUS" in re.sub(".\b", "", done.stdout)


def test_the_example_of_the_readme_runs(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("minirt.view", lambda scene: scene, raising=False)
    names: dict[str, object] = {}
    exec(block("README.md", "python", "minirt.load"), names)
    assert (folder / "demo.png").read_bytes().startswith(b"\x89PNG")
    assert names["scene"].spheres[0].diameter == 3  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("page", "words", "written"),
    [
        ("minirt/rendering/README.md", "Camera.look_at", "beads.png"),
        ("minirt/rendering/README.md", "minirt.save_movie", "jump.gif"),
        ("minirt/cluster/README.md", "minirt.render_to", "large.tif"),
    ],
)
def test_examples_write_their_pictures(page: str, words: str, written: str, folder: Path) -> None:
    exec(block(page, "python", words), {"minirt": minirt})
    assert (folder / written).stat().st_size > 100


def test_rays_are_traced() -> None:
    names: dict[str, object] = {"minirt": minirt, "scene": minirt.load(ROOT / "scenes/demo.rt")}
    exec(block("minirt/rendering/README.md", "python", "minirt.trace"), names)
    assert names["hits"].distance.shape == (1,)  # type: ignore[attr-defined]


def test_the_viewer_of_notebooks_opens() -> None:
    require("anywidget")
    names: dict[str, object] = {}
    exec(block("minirt/viewer/README.md", "python", "notebook=True"), names)
    names["viewer"].close()  # type: ignore[attr-defined]


def test_the_scene_is_read_and_the_errors_are_printed_as_shown(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "scene.rt").write_text(block("scenes/README.md", "", "A 0.2"))
    assert main(["scene.rt", "--check"]) == 0
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
