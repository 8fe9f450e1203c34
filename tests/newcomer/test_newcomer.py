"""Shapes, materials, a light and a key, added as `minirt/README.md` says, pass what is asked of every one.

They are added to a copy of the project, in the files that the page names: a capsule, which is a union of a tube and two
balls; a highlight, which the kernel knows, and a roughness, for which it gets a formula; a torch; and a key.
"""

from __future__ import annotations

import os
import re
import shutil
import sys
from pathlib import Path

import pytest

from tests.newcomer.additions import ADDITIONS, add
from tests.pages import read
from tests.paths import ROOT
from tests.processes import run

QUESTIONS = ("tests/shapes/test_protocol.py", "tests/shapes/test_mapping.py", "tests/stability/test_exact.py")
TABLES = (  # what depends on lists of all names
    "tests/test_pages.py::test_generated_parts_are_as_generated",
    "tests/test_pages.py::test_what_pages_name_exists",
    "tests/test_typed.py",
    "tests/viewer/test_language.py",
)
EDITING = "tests/viewer/editing/test_every_kind.py"
KEYS = "tests/viewer/test_bindings.py"
CACHE = ROOT / "out" / "newcomer"  # of kernels, which stay for the next run, as those of the project do
FOLDERS = ("minirt", "tests", "scenes", "assets", ".ci")
FILES = ("pyproject.toml", "Makefile", "LICENSE", *(path.name for path in ROOT.glob("*.md")))
ROW = re.compile(r"^\| (a\w* [\w ]+) \|(.*)\|(.*)\|$", re.MULTILINE)
ROWS = {
    "a shape": "capsule",
    "a material": "sheen",
    "a material with a formula": "rough",
    "a light": "torch",
    "a key": "copy line",
}


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the project with all additions, and with the tables of its pages written anew."""
    root = tmp_path_factory.mktemp("copy")
    for folder in FOLDERS:
        ignored = shutil.ignore_patterns("__pycache__", "goldens", "ahead_of_time")
        shutil.copytree(ROOT / folder, root / folder, ignore=ignored)
    for file in FILES:
        shutil.copy(ROOT / file, root)
    for addition in ADDITIONS.values():
        add(addition, root)
    answers(root, "-m", "tests.make_tables")
    return root


def answers(copy: Path, *command: str) -> str:
    """Run a Python program in the copy, with imports from there, and return what it prints; it must succeed."""
    environment = {
        **os.environ,
        "MINIRT_REQUIRE_WINDOW": "",
        "PYTHONPATH": str(copy),
        "XDG_CACHE_HOME": str(CACHE),
    }
    done = run([sys.executable, *command], cwd=copy, env=environment, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return str(done.stdout)


def passed(copy: Path, words: str, *tests: str) -> str:
    """Run the tests of the copy whose names have some words, and return what pytest says; some must pass, and all."""
    told = answers(copy, "-m", "pytest", "-p", "no:xdist", "-p", "no:cacheprovider", "-rs", "-k", words, *tests)
    assert " passed" in told
    return told


def test_the_page_names_the_files_of_each_addition() -> None:
    rows = {name: (new, changed) for name, new, changed in ROW.findall(read("minirt/README.md"))}
    assert set(rows) == set(ROWS)
    for name, columns in rows.items():
        new, changed = ({cell.strip("`") for cell in column.split()} for column in columns)
        addition = ADDITIONS[ROWS[name]]
        assert addition.folders == {placed(each) for each in new}, name
        assert addition.files == {placed(each) for each in changed}, name


def placed(name: str) -> str:
    """The path of a file or a folder that the page names: one of the package, if not of the tests."""
    return name if name.startswith("tests/") else f"minirt/{name}"


def test_a_new_shape_passes_the_questions_asked_of_every_shape(copy: Path) -> None:
    told = passed(copy, "capsule or each_kind", *QUESTIONS)
    assert "the reference renderer knows no capsule: with `surface_point` in" in told


def test_what_is_new_is_added_edited_and_saved_by_keys(copy: Path) -> None:
    passed(copy, "[ca or sheen or rough or [fl", EDITING)
    passed(copy, "copy or every or twice", KEYS)


def test_its_names_are_typed_and_in_the_tables_and_stay_english_in_french(copy: Path) -> None:
    passed(copy, "not runs", *TABLES)
    for check in (["check"], ["format", "--check"]):
        answers(copy, "-m", "ruff", *check, "minirt", "tests/viewer")
    listed = read_in(copy, "minirt/viewer/locale/fr.po").partition("No translation")[2]
    words = ("capsule", "rough", "roughness of a matt surface", "torch", "copy the line of the element")
    assert [word for word in words if f'msgid "{word}"\nmsgstr ""\n' not in listed] == []
    assert "    capsules: tuple[Capsule, ...]\n" in read_in(copy, "minirt/scene/element_lists.pyi")
    assert "| copy the line of the element | `J` |  |" in read_in(copy, "minirt/viewer/README.md")
    assert "| `ca x,y,z ax,ay,az diameter height R,G,B` | capsule |" in read_in(copy, "scenes/README.md")


def read_in(copy: Path, page: str) -> str:
    return (copy / page).read_text(encoding="utf-8")


PROGRAM = """
import numpy as np
import minirt
from minirt.rendering.packing.features import features

assert {"Capsule", "Rough", "Sheen", "Torch"} <= set(minirt.__all__)

# A capsule from y = -2.5 to y = 2.5 and one unit thick. The torch is at the eye; three quarters of its light arrive.
HEAD = "A 0.1 255,255,255\\nC 0,0,-9 0,0,1 40\\nfl 0,0,-9 0.6 32 255,255,255\\n"
BEHIND = "ca 0,0,-99 0,1,0 1 1 9,9,9 sheen:0.3 rough:0.5\\n"  # the eye: with it all scenes have one kernel

def scene(attribute, more=""):
    return minirt.loads(f"{HEAD}ca 0,0,0 0,1,0 2 3 200,90,50{attribute}\\n{more}")

plain, soft, rough = map(scene, ("", " sheen:0.3", " rough:0.5"))
assert (soft.capsules[0].sheen, rough.capsules[0].rough) == (minirt.Sheen(0.3), minirt.Rough(0.5))
assert (soft.torches[0].fade, minirt.Capsule((0, 0, 0), (0, 1, 0), 2, 3, (1, 2, 3)).height) == (32, 3)
assert minirt.dumps(soft).endswith("ca 0,0,0 0,1,0 2 3 200,90,50 sheen:0.3\\n")
assert (features(soft) - features(plain), features(rough) - features(plain)) == ({"specular"}, {"rough"})

colour, flame = np.array([200, 90, 50]) / 255, 0.6 * (1 - 8 / 32)
flat = 1 - 0.5 * 0.25 / (0.25 + 0.33)  # of Oren and Nayar A alone, as seen from the light
wanted = [(0.1 + flame) * colour, (0.1 + flame) * colour + 0.3 * flame, (0.1 + flame * flat) * colour]
for attribute, light in zip(("", " sheen:0.3", " rough:0.5"), wanted, strict=True):
    assert np.allclose(minirt.render(scene(attribute, BEHIND), 9, 9).linear[4, 4], light), attribute

origins = [[0, 0, -9], [0, 1, -9], [0, 9, 0], [0, -9, 0], [9, 0, 0], [0.6, 9, 0], [0, 0, 0], [0, 9, 1.001]]
directions = [[0, 0, 1], [0, 0, 1], [0, -1, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 1, 0], [0, -1, 0]]
hits = minirt.trace(plain, origins, directions)
assert np.allclose(hits.distance, [8, 8, 6.5, 6.5, 8, 9 - 1.5 - 0.8, 2.5, np.inf], rtol=1e-14, atol=0)
normals = [[0, 0, -1], [0, 0, -1], [0, 1, 0], [0, -1, 0], [1, 0, 0], [0.6, 0.8, 0]]
assert np.allclose(hits.normal[:6], normals, rtol=0, atol=1e-14)
assert hits.backward_error[:7].max() <= 4
"""


def test_what_is_new_is_read_drawn_and_public(copy: Path) -> None:
    answers(copy, "-c", PROGRAM)
