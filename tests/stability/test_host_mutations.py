"""The changes of host code by which its tests are tested."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests import processes
from tests.paths import PACKAGE, ROOT
from tests.stability.host_explained import Explanation, explanations
from tests.stability.host_mutations import host_changes
from tests.stability.host_tests import Choice, Recorded, executable_line

SOURCE = '''
LIMIT = 7

def check(a, b=2):
    """No change here."""
    if a <= b and not a:
        raise ValueError(f(a, b))
    print(zip(a, strict=True))
    return True
'''


def test_every_place_of_a_function_is_changed() -> None:
    made = [make() for make in host_changes(SOURCE)]
    assert sorted((change.line, change.before, change.after) for change in made) == [
        (6, "a <= b", "a < b"),
        (6, "a <= b", "a >= b"),
        (6, "a <= b and (not a)", "a <= b or not a"),
        (6, "not a", "a"),
        (7, "f(a, b)", "f(b, a)"),
        (7, "raise ValueError(f(a, b))", "pass"),
        (8, "print(zip(a, strict=True))", "pass"),
        (9, "True", "False"),
    ]
    assert len({compile(change.tree, "changed", "exec").co_consts for change in made}) == len(made)


def places_of(explanation: Explanation) -> Iterator[str]:
    """Yield the changes that can be made in the lines of an explanation."""
    source = (PACKAGE / explanation.file).read_text(encoding="utf-8")
    for change in (make() for make in host_changes(source, explanation.line)):
        yield f"{change.before} -> {change.after}"


@pytest.mark.parametrize("file", sorted({each.file for each in explanations()}))
def test_every_explained_change_can_still_be_made(file: str) -> None:
    for each in explanations():
        if each.file == file:
            assert set(each.changes) <= set(places_of(each)), each.line
            assert each.reason


def choice(tests: list[Recorded]) -> Choice:
    """A choice among tests that no file records."""
    made = Choice.__new__(Choice)
    made.package, made.tests, made.failed = PACKAGE, tests, []
    return made


def test_quick_tests_of_a_line_come_first_and_near_ones_before_far_ones() -> None:
    path = Path("scene/fast.py")
    line = max(executable_line(PACKAGE / path, at) for at in range(60))
    seconds = {"far": ("tests/viewer/test_layers.py", 0.1), "slow": ("tests/scene/test_fast.py", 5.0)}
    seconds |= {"own": ("tests/scene/test_fast.py", 0.5), "near": ("tests/scene/test_save.py", 0.2)}
    tests = [Recorded(f"{file}::{name}", took, {str(path): {line}}) for name, (file, took) in seconds.items()]
    tests.append(Recorded("tests/scene/test_save.py::other", 0.1, {str(path): {1}}))
    chosen = choice(tests).tests_of(path, line, 1e9)
    assert [test.name.split("::")[1] for test in chosen] == ["own", "near", "far", "slow"]
    assert [test.name.split("::")[1] for test in choice(tests).tests_of(path, line, 0.75)] == ["own", "near"]


def test_a_line_that_no_test_is_seen_to_run_has_the_tests_of_its_folder() -> None:
    tests = [Recorded(f"tests/{name}.py::it", 0.1, {}) for name in ("scene/test_save", "cli/test_output")]
    assert choice(tests).tests_of(Path("scene/fast.py"), 3, 1e9) == tests[:1]


PROJECT = {
    "minirt/__init__.py": "",
    "minirt/half.py": "def half(x):\n    if x < 0:\n        raise ValueError\n    return x / 2\n",
    "tests/test_half.py": "from minirt.half import half\n"
    "def test_half():\n    assert half(4) == 2\n"
    "def test_wrong():\n    assert half(4) == 3\n",
}
PROGRAM = """
import shutil, sys
from pathlib import Path
from tests.stability.host_copy import ProjectCopy
from tests.stability.host_tests import Choice
from tests.stability.host_trial import outcome, record

folder = Path(sys.argv[1])
project = ProjectCopy(folder / "copy", folder / "source")
record(project, ["tests"], "", float("inf"), folder / "record.json")
choice = Choice(folder / "source" / "minirt", folder / "record.json")
path = project.root / "minirt" / "half.py"
names = [test.name for test in choice.tests_of(Path("half.py"), 4, float("inf"))]
print(choice.failed, names, file=sys.stderr)
right = path.read_text()
for source in (right, right.replace("x / 2", "x * 2"), right.replace("x < 0", "x < 1")):
    path.write_text(source)
    print(outcome(project, names, float("inf")), file=sys.stderr)
print(outcome(project, names, 0.0), file=sys.stderr)
"""


def test_the_tests_of_a_line_run_in_a_copy_and_those_that_fail_unchanged_are_left_out(tmp_path: Path) -> None:
    for name, source in PROJECT.items():
        (tmp_path / "source" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "source" / name).write_text(source)
    said = processes.run([sys.executable, "-c", PROGRAM, str(tmp_path)], cwd=ROOT, text=True).stderr
    first, *outcomes = said.splitlines()
    assert first == "['tests/test_half.py::test_wrong'] ['tests/test_half.py::test_half']"
    assert outcomes == ["survived", "killed", "survived", "late"]
