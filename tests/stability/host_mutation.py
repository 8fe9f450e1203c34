"""Mutation testing of host code: change it, one place at a time, and list the changes that no test notices.

    python -m tests.stability.host_mutation scene viewer/editing rendering/running/cores.py
    python -m tests.stability.host_mutation rendering --count 40 --seed 2

A name is a folder or a file of the package. `--count` draws so many of its changes at random. Each change is tested in
a copy of the project, by the tests of its own file and then by those of its folder, but for slow ones and windows. The
formulas have a tool of their own, `tests.stability.mutation`, which needs no new process for a change.
"""

from __future__ import annotations

import argparse
import ast
import os
import random
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from queue import SimpleQueue
from threading import Thread

from minirt.rendering.running.cores import usable_cores
from tests.paths import PACKAGE, ROOT
from tests.stability.host_mutations import host_changes
from tests.stability.mutations import Change
from tests.waiting import HANG_LIMIT

COPIED = ("minirt", "tests", "scenes", "assets", "pyproject.toml", "Makefile", "README.md", "CHANGELOG.md")
QUICK = ("-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-m", "not window and not slow")
Work = tuple[Path, Callable[[], Change]]  # a file, relative to the package, and what makes its change


def main(arguments: list[str]) -> int:
    """Print the surviving changes, and return whether there are any."""
    parser = argparse.ArgumentParser(prog="python -m tests.stability.host_mutation")
    parser.add_argument("names", nargs="+", help="folders and files of the package")
    parser.add_argument("--count", type=int, help="test so many changes, drawn at random (default: all)")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args(arguments)
    files = [path for name in given.names for path in files_of(PACKAGE / name)]
    work = [(path.relative_to(PACKAGE), make) for path in files for make in host_changes(path.read_text())]
    if given.count is not None:
        work = random.Random(given.seed).sample(work, min(given.count, len(work)))
    (ROOT / "out").mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(dir=ROOT / "out") as folder:
        whole = project_copy(Path(folder) / "whole")
        for path in sorted({path for path, _ in work}):
            if not passes(whole, path):
                raise SystemExit(f"the tests of {path} fail without any change")
        survivors = run(work, Path(folder))
    print(f"{survivors} of {len(work)} changes pass their tests")
    return survivors > 0


def files_of(path: Path) -> list[Path]:
    """Return the sources in a folder, or the one source."""
    return sorted(path.rglob("*.py")) if path.is_dir() else [path]


def project_copy(folder: Path) -> Path:
    """Copy the project by hard links."""
    for name in COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, folder / name, copy_function=os.link)
        elif source.exists():
            os.link(source, folder / name)
    return folder


def run(work: list[Work], folder: Path) -> int:
    """Test all changes, one on each core at a time; print the survivors, and return their number."""
    waiting: SimpleQueue[Work | None] = SimpleQueue()
    survivors: SimpleQueue[Change] = SimpleQueue()
    cores = usable_cores()
    for each in [*work, *[None] * cores]:
        waiting.put(each)
    threads = [Thread(target=test_all, args=(waiting, survivors, folder / str(i))) for i in range(cores)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return survivors.qsize()


def test_all(waiting: SimpleQueue[Work | None], survivors: SimpleQueue[Change], folder: Path) -> None:
    """Test changes in a copy of the project until none is waiting."""
    project_copy(folder)
    while (each := waiting.get()) is not None:
        path, change = each[0], each[1]()
        target = folder / "minirt" / path
        target.unlink()
        target.write_text(ast.unparse(change.tree))
        if passes(folder, path):
            survivors.put(change)
            print(f"minirt/{path}:{change.line}: {change.before}  ->  {change.after}", flush=True)
        target.unlink()
        os.link(PACKAGE / path, target)


def passes(folder: Path, path: Path) -> bool:
    """Whether the tests of a file pass in a copy of the project; a hang is a failure."""
    command = [sys.executable, "-m", "pytest", *QUICK, *selected_tests(path)]
    try:
        ended = subprocess.run(command, check=False, cwd=folder, capture_output=True, timeout=HANG_LIMIT)
    except subprocess.TimeoutExpired:
        return False
    return ended.returncode == 0


def selected_tests(path: Path) -> list[str]:
    """Return the tests of a file of the package: its own first, then those of the closest folder that has tests."""
    own = Path("tests") / path.parent / f"test_{path.name}"
    folder = next(each for each in own.parents if (ROOT / each).is_dir())
    return [str(own), str(folder)] if (ROOT / own).exists() else [str(folder)]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
