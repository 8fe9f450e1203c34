"""A made-up shape and material, added as `minirt/README.md` says, pass the questions asked of every kind.

They are added to a copy of the project: for the shape its file and a line in the registry; for the material its class
and a field in the registry.
"""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

import pytest

from tests.paths import ROOT
from tests.processes import run

HERE = Path(__file__).parent
QUESTIONS = (
    "tests/shapes/test_protocol.py",
    "tests/shapes/test_mapping.py",
    "tests/stability/test_exact.py",
)
EDITING = "tests/viewer/editing/test_every_kind.py"


def add_line(path: Path, anchor: str, line: str) -> None:
    """Put a line below the one that is the anchor."""
    text = path.read_text()
    assert text.count(f"{anchor}\n") == 1, f"{path} has no line {anchor!r}"
    path.write_text(text.replace(f"{anchor}\n", f"{anchor}\n{line}\n"))


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the project to which the gate and the sheen have been added."""
    root = tmp_path_factory.mktemp("copy")
    for folder in ("minirt", "tests", "scenes"):
        shutil.copytree(ROOT / folder, root / folder, ignore=shutil.ignore_patterns("__pycache__", "goldens"))
    shutil.copy(ROOT / "pyproject.toml", root)
    package = root / "minirt"

    shutil.copy(HERE / "gate.py", package / "shapes")
    add_line(
        package / "shapes/__init__.py",
        "from minirt.shapes.ellipsoid import Ellipsoid as Ellipsoid",
        "from minirt.shapes.gate import Gate as Gate",
    )

    registry = package / "materials/__init__.py"
    _, sheen = (HERE / "sheen.py").read_text().split("# The class, which goes into minirt/materials/__init__.py.\n")
    add_line(registry, 'MAPPED: dict[str, Any] = {"mapped": True} | SHARED', sheen)
    add_line(
        registry,
        '    wood: Wood | None = declare(Compound, "rings of wood", record=Wood, default=None, shared=WOOD)',
        '    sheen: Sheen | None = declare(Compound, "soft highlight", record=Sheen, default=None, shared=SHARED)',
    )
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


def test_a_new_shape_passes_the_questions_asked_of_every_shape(copy: Path) -> None:
    told = answers(
        copy,
        "-m",
        "pytest",
        "-p",
        "no:xdist",
        "-rs",
        "-k",
        "gate or every_kind",
        *QUESTIONS,
    )
    assert "passed" in told
    assert "the reference renderer knows no gate: with `surface_point` in" in told


def test_a_new_shape_and_a_new_material_are_added_edited_and_saved_by_keys(copy: Path) -> None:
    told = answers(copy, "-m", "pytest", "-p", "no:xdist", "-k", "[ga or sheen", EDITING)
    assert "passed" in told


PROGRAM = """
import numpy as np
import minirt
from minirt.rendering.packing.features import features
from minirt.scene import dump, parse
from tests.make_tables import FURTHER, attribute_table, element_table

assert minirt.Gate((0, 0, 0), 2, (1, 2, 3)).side == 2
assert {"Gate", "Sheen"} <= set(minirt.__all__)
assert "| `ga x,y,z side R,G,B` | gate |" in element_table(FURTHER)
assert "`sheen:share`" in attribute_table()

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


def test_a_new_shape_and_a_new_material_are_read_drawn_and_public(copy: Path) -> None:
    answers(copy, "-c", PROGRAM)
