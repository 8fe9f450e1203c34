"""The changes of host code by which its tests are tested."""

from __future__ import annotations

from pathlib import Path

from tests.paths import TESTS
from tests.stability.host_mutation import selected_tests
from tests.stability.host_mutations import host_changes

SOURCE = '''
LIMIT = 7

def check(a, b=2):
    """No change here."""
    if a <= b and not a:
        raise ValueError(f(a, b))
    print(a)
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
        (8, "print(a)", "pass"),
        (9, "True", "False"),
    ]
    assert len({compile(change.tree, "changed", "exec").co_consts for change in made}) == len(made)


def test_a_file_is_tested_by_its_own_tests_and_by_those_of_its_folder() -> None:
    assert selected_tests(Path("scene/fast.py")) == ["tests/scene/test_fast.py", "tests/scene"]
    assert selected_tests(Path("scene/parser.py")) == ["tests/scene"]
    assert all((TESTS.parent / each).exists() for each in selected_tests(Path("viewer/editing/state.py")))
