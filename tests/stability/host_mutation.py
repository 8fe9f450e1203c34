"""Mutation testing of host code: change it, one place at a time, and list the changes that no test notices.

    python -m tests.stability.host_mutation scene viewer/editing rendering/running/cores.py
    python -m tests.stability.host_mutation rendering --count 40 --seed 2

A name is a folder or a file of the package. `--count` draws so many of its changes at random. The tests run once
without a change, which records the lines that each runs (`--record` keeps that for later runs). Then each change is
tested in a copy of the project by the tests that run its line, near and quick ones first, until one fails. Tests that
open windows take no part, nor those that fail without a change. The formulas have a tool of their own,
`tests.stability.mutation`.
"""

from __future__ import annotations

import argparse
import ast
import random
import re
import shutil
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from tests.paths import PACKAGE, ROOT
from tests.stability.host_copy import ProjectCopy
from tests.stability.host_explained import is_explained
from tests.stability.host_mutations import host_changes
from tests.stability.host_tests import Choice
from tests.stability.host_trial import outcome, record
from tests.stability.mutations import Change

TESTS = ("cli", "kernel", "materials", "meshes", "rendering", "scene", "viewer", "test_library.py", "test_image.py")
Work = tuple[Path, Callable[[], Change]]  # a file, relative to the package, and what makes its change


def main(arguments: list[str]) -> int:
    """Print the surviving changes and a summary by folder, and return whether there are any."""
    parser = argparse.ArgumentParser(prog="python -m tests.stability.host_mutation")
    parser.add_argument("names", nargs="+", help="folders and files of the package")
    parser.add_argument("--count", type=int, help="test so many changes, drawn at random (default: all)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=3.0, help="test a change for so long at most (default: 3)")
    parser.add_argument(
        "--marks", default="not window and not slow", help="tests that take part (default: %(default)s)"
    )
    parser.add_argument("--tests", nargs="+", default=TESTS, help="folders and files of tests (default: %(default)s)")
    parser.add_argument("--record", type=Path, help="file of the record, written if it does not exist")
    parser.add_argument(
        "--again", type=Path, help="test the survivors and late ones in this output of an earlier run alone"
    )
    given = parser.parse_args(arguments)
    files = [path for name in given.names for path in files_of(PACKAGE / name)]
    work = [(path.relative_to(PACKAGE), make) for path in files for make in host_changes(path.read_text())]
    if given.again:
        survived = set(re.findall(r"^(?:survived|late) .* s: minirt/(.*)$", given.again.read_text(), re.MULTILINE))
        work = [(path, make) for path, make in work if described(path, make()) in survived]
    if given.count is not None:
        work = random.Random(given.seed).sample(work, min(given.count, len(work)))
    (ROOT / "out").mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(dir=ROOT / "out") as folder:
        project = ProjectCopy(Path(folder))
        results = test_all(work, project, chosen(project, given), given.seconds)
    return summary(results)


def files_of(path: Path) -> list[Path]:
    """Return the sources in a folder, or the one source."""
    return sorted(path.rglob("*.py")) if path.is_dir() else [path]


def chosen(project: ProjectCopy, given: argparse.Namespace) -> Choice:
    """Record the unchanged tests, unless that was done before, and return what chooses among them."""
    path = (given.record or project.root.parent / "record.json").resolve()
    kernels = path.with_suffix(".kernels")
    if path.exists():
        shutil.copytree(kernels, project.kernels)
    else:
        record(project, [f"tests/{each}" for each in given.tests], given.marks, float("inf"), path)
        project.kernels.mkdir(exist_ok=True)
        shutil.copytree(project.kernels, kernels)
    choice = Choice(project.root / "minirt", path)
    for name in choice.failed:
        print(f"left out, since it fails without any change: {name}", flush=True)
    return choice


def test_all(work: list[Work], project: ProjectCopy, choice: Choice, seconds: float) -> Counter[tuple[str, str]]:
    """Test changes one after the other; return the number of each result in each folder."""
    results: Counter[tuple[str, str]] = Counter()
    for path, make in work:
        change = make()
        line = (PACKAGE / path).read_text(encoding="utf-8").splitlines()[change.line - 1].strip()
        started = time.monotonic()
        explained = is_explained(path, line, f"{change.before} -> {change.after}")
        result = "explained" if explained else tested(path, change, project, choice, seconds)
        took = time.monotonic() - started
        print(f"{result} {took:.1f} s: minirt/{described(path, change)}", flush=True)
        results[path.parent.as_posix(), result] += 1
    return results


def described(path: Path, change: Change) -> str:
    """Return a change in words."""
    return f"{path}:{change.line}: {change.before}  ->  {change.after}"


def tested(path: Path, change: Change, project: ProjectCopy, choice: Choice, seconds: float) -> str:
    """Run the tests of a line with a change of it: killed, survived, or late if the tests take far too long."""
    tests = choice.tests_of(path, change.line, seconds)
    target = project.root / "minirt" / path
    target.write_text(ast.unparse(change.tree), encoding="utf-8")
    limit = 20.0 + 3.0 * sum(test.seconds for test in tests)
    try:
        return outcome(project, [test.name for test in tests], limit)
    finally:
        shutil.copy2(PACKAGE / path, target)


def summary(results: Counter[tuple[str, str]]) -> int:
    """Print the results by folder, and return whether a change survived."""
    kinds = ("killed", "late", "survived", "explained")
    print(f"{'folder':<24}", *(f"{kind:>9}" for kind in kinds))
    for folder in sorted({folder for folder, _ in results}):
        print(f"{folder:<24}", *(f"{results[folder, kind]:>9}" for kind in kinds))
    totals = [sum(number for (_, kind), number in results.items() if kind == each) for each in kinds]
    print(f"{'all':<24}", *(f"{total:>9}" for total in totals))
    return totals[2] > 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
