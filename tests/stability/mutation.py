"""Changes the formulas, one place at a time, and lists the changes that no test notices.

    python -m tests.stability.mutation [sphere cylinder ...]
    python -m tests.stability.mutation trace shade

The interpreted tests run once, so that all is imported and all right answers are known; then each change gets a copy of
this process (POSIX only) in which the functions have the changed code, and the regimes and then the tests are tried
again until one fails. A change that they let pass, and that is no other way to write the same, calls for a test.
Files of the kernel, which must not be mixed with those of shapes, are tested by pictures that are made uncompiled.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from importlib import import_module
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

import pytest

import minirt.shapes
from minirt.rendering.queries import preview
from minirt.rendering.running.cores import usable_cores
from minirt.scene import Scene
from tests.kernel import pictures
from tests.paths import PACKAGE
from tests.shapes.execution_modes import on_arrays
from tests.stability.mutations import Change, changes
from tests.stability.regime import posed
from tests.stability.table import REGIMES

SHARED = ("quadric", "compensated", "basis", "bounds")  # of several shapes
TOPICS = {"uv_mapping": "mapping"}  # what the tests of a file are called, where not as the file
FILES = (*SHARED, *TOPICS, "pyramid", *(kind.element.__module__.rpartition(".")[2] for kind in minirt.shapes.ALL_KINDS))
TESTS = ("tests/shapes", "tests/stability/test_surfaces.py", "tests/stability/test_properties.py")
# What starts threads does not survive a fork.
UNFIT = "not traced and not compiled and not reintersection and not pictures and not mutants and not length_of"
KERNEL = {"trace": "kernel/trace.py", "shade": "kernel/shading/shade.py"}
PICTURES = (
    *(f"tests/kernel/test_{name}.py" for name in ("coincident", "extremes", "invariances")),
    *(f"tests/kernel/shading/test_{name}.py" for name in ("lights", "specular", "whitted")),
    "tests/stability/test_pictures.py",
    "tests/rendering/culling/test_visibility.py",
)
COMPILED = "not compiled and not every_scene and not many_shapes and not light_is_finite and not lists_begin"
SECONDS = 120  # a change may make a loop endless


def main(names: list[str]) -> int:
    """Print the survivors, and return whether there are any."""
    names = names or [*FILES]
    if any(map(fails, names)) or tested(names) != 0:
        raise SystemExit("the tests fail without any change")
    work = [(name, change) for name in names for change in changes((PACKAGE / path_of(name)).read_text())]
    running: dict[int, tuple[str, Change]] = {}
    survivors, started = 0, time.monotonic()
    for each in work:
        if len(running) >= usable_cores():
            survivors += ended(running)
        running[tried(*each)] = each
    while running:
        survivors += ended(running)
    print(f"{survivors} of {len(work)} changes pass all tests; {time.monotonic() - started:.0f} s")
    return survivors > 0


def tested(names: list[str]) -> int:
    """Run the tests of some files, those of a shape's file by its name; 0 if all pass."""
    if set(names) <= set(KERNEL):
        pictures.picture = interpreted
        return int(pytest.main([*PICTURES, "-x", "-q", "-p", "no:cacheprovider", "-k", COMPILED]))
    own = [f"tests/shapes/test_{name}.py" for name in names]  # first: they tell soonest
    topics = " or ".join(TOPICS.get(name, name) for name in names)
    chosen = UNFIT if set(names) & set(SHARED) else f"{UNFIT} and ({topics})"
    return int(pytest.main([*filter(os.path.exists, own), *TESTS, "-x", "-q", "-p", "no:cacheprovider", "-k", chosen]))


def interpreted(scene: Scene, width: int = 24, height: int = 16, samples: int = 1, renderer: object = None) -> Any:
    """`tests.kernel.pictures.picture` without the compiler."""
    return preview.picture(scene, width, height)


def path_of(name: str) -> str:
    """The file of that name, in the package."""
    return KERNEL.get(name, f"shapes/{name}.py")


def fails(name: str) -> bool:
    """Whether a regime already tells that the formulas of a file have been changed: most changes are found at once."""
    rights = [posed(regime) for kind, regime in REGIMES if name in SHARED or kind.element.__module__.endswith(name)]
    return any(any(right.errors(on_arrays(*right.rays))) for right in rights)


def tried(name: str, change: Change) -> int:
    """The number of a process that runs the tests with a change; it ends with 0 if they all pass."""
    process = os.fork()
    if process:
        return process
    try:
        signal.alarm(SECONDS)
        nothing = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nothing, 1)
        os.dup2(nothing, 2)
        put(import_module(f"minirt.{path_of(name)[:-3].replace('/', '.')}"), change)
        os._exit(fails(name) or tested([name]))
    finally:
        os._exit(1)


def ended(running: dict[int, tuple[str, Change]]) -> bool:
    """Wait for the next process to end: whether its change has passed all tests, or they took too long to tell."""
    process, status = os.wait()
    name, change = running.pop(process)
    late = " (too slow)" if os.WIFSIGNALED(status) else ""
    if status == 0 or late:
        print(f"minirt/{path_of(name)}:{change.line}: {change.before}  ->  {change.after}{late}", flush=True)
    return status == 0


def put(module: ModuleType, change: Change) -> None:
    """Give the functions and constants of a module what they are after a change."""
    changed: dict[str, Any] = {"__name__": module.__name__}
    exec(compile(change.tree, str(module.__file__), "exec"), changed)
    for name, new in changed.items():
        old = getattr(module, name)
        if isinstance(new, (int, float, tuple)):
            for user in users_of(module, name):
                setattr(user, name, new)
        elif isinstance(new, FunctionType) and new.__module__ == module.__name__:
            old.__code__ = new.__code__
        elif isinstance(new, type) and new.__module__ == module.__name__:
            for method, value in vars(new).items():
                if isinstance(value, FunctionType) and value.__code__.co_filename == module.__file__:
                    vars(old)[method].__code__ = value.__code__


def users_of(module: ModuleType, name: str) -> list[ModuleType]:
    """Those of the package that have a constant of one of its modules, and it itself."""
    imports = f"from {module.__name__} import "
    found = [each for each in sys.modules.values() if each.__name__.startswith("minirt.") and hasattr(each, name)]
    return [each for each in found if each is module or imports in Path(str(each.__file__)).read_text()]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
