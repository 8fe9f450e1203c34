"""Changes the formulas, one place at a time, and lists the changes that no test notices.

    python -m tests.stability.mutation [sphere cylinder ...]
    python -m tests.stability.mutation trace shade

The interpreted tests run once, so that all is imported and all right answers are known; then each change gets a copy of
this process (POSIX only) in which the functions have the changed code and the tests run again until one fails. A change
that they let pass, and that is no other way to write the same, calls for a test. The files of the kernel are tested by
pictures that they make uncompiled.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from types import FunctionType, ModuleType
from typing import TYPE_CHECKING, Any

import pytest

import minirt
from minirt.rendering import preview
from minirt.rendering.cores import usable_cores
from minirt.shapes import KINDS
from tests.kernel import pictures
from tests.stability.mutations import Change, changes

if TYPE_CHECKING:
    from minirt.scene import Scene

FOLDERS = ("shapes", "kernel")
FILES = ("quadric", "exact", "basis", "sphere", "plane", "cylinder")
KERNEL = ("trace", "shade")
TESTS = ("tests/stability/test_regimes.py", "tests/stability/test_surfaces.py", "tests/shapes", "tests/stability")
THREADED = "not traced and not compiled and not reintersection and not pictures and not mutants and not length_of"
OPTIONS = ("-x", "-q", "-p", "no:cacheprovider", "-k")  # what starts threads does not survive a fork
PICTURES = (
    *(f"tests/kernel/test_{name}.py" for name in ("coincident", "extremes", "invariances", "lamps", "highlight")),
    *("tests/stability/test_pictures.py", "tests/kernel/test_whitted.py", "tests/rendering/test_sight.py"),
)
COMPILED = "not compiled and not every_scene and not many_shapes and not light_is_finite and not lists_begin"
SECONDS = 120  # a change may make a loop endless


def main(names: list[str]) -> int:
    """Print the survivors, and return whether there are any."""
    tests = tests_of(names or FILES)
    if pytest.main(tests) != 0:
        raise SystemExit("the tests fail without any change")
    work = [(name, change) for name in names or FILES for change in changes(path_of(name).read_text())]
    running: dict[int, tuple[str, Change]] = {}
    survivors, started = 0, time.monotonic()
    for each in work:
        if len(running) >= usable_cores():
            survivors += ended(running)
        running[tried(*each, tests)] = each
    while running:
        survivors += ended(running)
    print(f"{survivors} of {len(work)} changes pass all tests; {time.monotonic() - started:.0f} s")
    return survivors > 0


def tests_of(names: Sequence[str]) -> list[str]:
    """What pytest is called with for some files."""
    if {*names} & {*KERNEL}:
        pictures.picture = interpreted
        return [*PICTURES, *OPTIONS, COMPILED]
    own = {*names} <= {kind.element.title for kind in KINDS}
    return [*TESTS, *OPTIONS, f"({' or '.join(names)}) and {THREADED}" if own else THREADED]


def interpreted(scene: Scene, width: int = 24, height: int = 16, samples: int = 1, renderer: object = None) -> Any:
    """`tests.kernel.pictures.picture` without the compiler."""
    return preview.picture(scene, width, height)


def path_of(name: str) -> Path:
    """The file of that name."""
    package = Path(minirt.__file__).parent
    return next(path for folder in FOLDERS if (path := package / folder / f"{name}.py").exists())


def tried(name: str, change: Change, tests: list[str]) -> int:
    """The number of a process that runs the tests with a change; it ends with 0 if they all pass."""
    process = os.fork()
    if process:
        return process
    try:
        signal.alarm(SECONDS)
        nothing = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nothing, 1)
        os.dup2(nothing, 2)
        put(import_module(f"minirt.{path_of(name).parent.name}.{name}"), change)
        os._exit(int(pytest.main(tests)))
    finally:
        os._exit(1)


def ended(running: dict[int, tuple[str, Change]]) -> bool:
    """Wait for the next process to end: whether its change has passed all tests."""
    process, status = os.wait()
    name, change = running.pop(process)
    if status == 0:
        print(f"{path_of(name).name}:{change.line}: {change.before}  ->  {change.after}", flush=True)
    return status == 0


def put(module: ModuleType, change: Change) -> None:
    """Give the functions and constants of a module what they are after a change."""
    changed: dict[str, Any] = {"__name__": module.__name__}
    exec(compile(change.tree, str(module.__file__), "exec"), changed)
    for name, new in changed.items():
        old = getattr(module, name)
        if isinstance(new, (int, float)):
            for user in users_of(module, name):
                setattr(user, name, new)
        elif isinstance(new, FunctionType) and new.__module__ == module.__name__:
            old.__code__ = new.__code__
        elif isinstance(new, type) and new.__module__ == module.__name__:
            for method, value in vars(new).items():
                if isinstance(value, FunctionType) and value.__code__.co_filename == module.__file__:
                    vars(old)[method].__code__ = value.__code__


def users_of(module: ModuleType, name: str) -> list[ModuleType]:
    """Those of a package that have a constant of one of its modules."""
    imports = f"from {module.__name__} import "
    found = [each for each in sys.modules.values() if each.__name__.startswith("minirt.") and hasattr(each, name)]
    return [each for each in found if each is module or imports in Path(str(each.__file__)).read_text()]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
