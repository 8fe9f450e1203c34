"""Shapes, materials, a light and a key, added as `minirt/README.md` says, pass what is asked of every one.

They are added to a copy of the project, in the files that the page names. The capsule is a union of a tube and two
balls; only its boundary states it exactly. The gate has a body of the oracle and special places.
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

QUESTIONS = (
    "tests/shapes/test_protocol.py",
    "tests/shapes/test_mapping.py",
    "tests/oracle",
    "tests/stability/test_degenerate.py",
)
TABLES = (  # what depends on lists of all names
    "tests/test_pages.py::test_generated_parts_are_as_generated",
    "tests/test_pages.py::test_what_pages_name_exists",
    "tests/test_typed.py",
    "tests/viewer/test_language.py",
)
EDITING = "tests/viewer/editing/test_every_kind.py"
KEYS = "tests/viewer/test_bindings.py"
FOLDERS = ("minirt", "tests", "scenes", "assets", ".ci")
FILES = ("pyproject.toml", "Makefile", "LICENSE", *(path.name for path in ROOT.glob("*.md")))
ROW = re.compile(r"^\| (a\w* [\w ]+) \|(.*)\|(.*)\|$", re.MULTILINE)
ROWS = {"a shape": "gate", "a material": "sheen", "a formula": "rough", "a light": "torch", "a key": "turn round"}


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
        "XDG_CACHE_HOME": str(copy / "cache"),
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


def test_new_shapes_pass_the_questions_asked_of_every_shape(copy: Path) -> None:
    told = passed(copy, "gate or every_kind or knows", *QUESTIONS)
    assert "the reference renderer knows no gate: with `surface_point` in" in told
    passed(copy, "capsule", QUESTIONS[0])


def test_what_is_new_is_added_edited_and_saved_by_keys(copy: Path) -> None:
    passed(copy, "[ga or [ca or sheen or rough or [fl", EDITING)
    passed(copy, "turn or every or twice", KEYS)


def test_its_names_are_typed_and_in_the_tables_and_stay_english_in_french(copy: Path) -> None:
    passed(copy, "not runs", *TABLES)
    for check in (["check"], ["format", "--check"]):
        answers(copy, "-m", "ruff", *check, "minirt", "tests/viewer")
    listed = read_in(copy, "minirt/viewer/locale/fr.po").partition("No translation")[2]
    words = ("gate", "capsule", "rough", "roughness of a matt surface", "torch", "look the other way")
    assert [word for word in words if f'msgid "{word}"\nmsgstr ""\n' not in listed] == []
    assert "    capsules: tuple[Capsule, ...]\n" in read_in(copy, "minirt/scene/element_lists.pyi")
    assert "| look the other way | `U` |  |" in read_in(copy, "minirt/viewer/README.md")
    assert "| `ca x,y,z ax,ay,az diameter height R,G,B` | capsule |" in read_in(copy, "scenes/README.md")


def read_in(copy: Path, page: str) -> str:
    return (copy / page).read_text(encoding="utf-8")


SHEEN = """
import numpy as np
import minirt
from minirt.rendering.packing.features import features
from minirt.scene import dump, parse

assert minirt.Gate((0, 0, 0), 2, (1, 2, 3)).side == 2
assert {"Capsule", "Gate", "Rough", "Sheen", "Torch"} <= set(minirt.__all__)

TEXT = "A 0.1 255,255,255\\nC 0,0,-9 0,0,1 40\\nL 0,0,-9 0.6 255,255,255\\nga 0,0,0 4 200,90,50\\n"
TEXTS = TEXT, TEXT.replace("90,50", "90,50 sheen:0.3")
plain, soft = (parse(text).scene for text in TEXTS)
assert soft.gates[0].sheen == minirt.Sheen(0.3)
assert dump(soft).endswith("ga 0,0,0 4 200,90,50 sheen:0.3\\n")
assert features(soft) - features(plain) == {"specular"}
BEHIND = "ga 0,0,-99 1 9,9,9 sheen:0.3\\n"  # the eye: with it both scenes have one kernel
light = [minirt.render(parse(text + BEHIND).scene, 9, 9).linear[4, 4] for text in TEXTS]
assert np.allclose(light[0], 0.7 * np.array([200, 90, 50]) / 255)
assert np.allclose(light[1] - light[0], 0.3 * 0.6)
hits = minirt.trace(plain, [[0.3, 0.1, -9]], [[0, 0.1, 1]])
assert hits.backward_error[0] <= 4 and hits.normal_error[0] == 0
"""
FLAME = """
import numpy as np
import minirt

# A capsule from y = -2.5 to y = 2.5, one unit thick, lit by a torch at the eye, of which a quarter arrives there.
scene = minirt.loads(
    "A 0.1 255,255,255\\nC 0,0,-9 0,0,1 40\\nfl 0,0,-9 0.6 32 255,255,255\\nca 0,0,0 0,1,0 2 3 200,90,50 rough:0.5\\n"
)
(flame,), (capsule,) = scene.torches, scene.capsules
assert (flame.fade, capsule.rough) == (32, minirt.Rough(0.5))
light = minirt.render(scene, 9, 9).linear[4, 4]
lambert, flat = 0.6 * (1 - 8 / 32), 1 - 0.5 * 0.25 / (0.25 + 0.33)  # seen from the light: A of Oren and Nayar alone
assert np.allclose(light, (0.1 + lambert * flat) * np.array([200, 90, 50]) / 255)

origins = [[0, 0, -9], [0, 1, -9], [0, 9, 0], [0, -9, 0], [9, 0, 0], [0.6, 9, 0], [0, 9, 1.001], [0, 0, 0]]
directions = [[0, 0, 1], [0, 0, 1], [0, -1, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, -1, 0], [0, 1, 0]]
hits = minirt.trace(scene, origins, directions)
assert np.allclose(hits.distance, [8, 8, 6.5, 6.5, 8, 9 - 1.5 - 0.8, np.inf, 2.5], rtol=1e-14, atol=0)
normals = [[0, 0, -1], [0, 0, -1], [0, 1, 0], [0, -1, 0], [1, 0, 0], [0.6, 0.8, 0]]
assert np.allclose(hits.normal[:6], normals, rtol=0, atol=1e-14)
assert np.nanmax(hits.backward_error[:6]) <= 4
"""


@pytest.mark.parametrize("program", [SHEEN, FLAME], ids=["sheen", "flame"])
def test_what_is_new_is_read_drawn_and_public(copy: Path, program: str) -> None:
    answers(copy, "-c", program)
