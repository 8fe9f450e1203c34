"""Mutation testing: change the formulas, one place at a time, and list the changes that no test notices.

    python -m tests.stability.mutation [sphere cylinder ...]
    python -m tests.stability.mutation trace shade

The interpreted tests run once, so that everything is imported and all right answers are known. Then each change gets a
fork of this process (POSIX only) in which the functions have the changed code; the regimes and then the tests run until
one fails. A change that survives, and is not just another way to write the same formula, calls for a new test.
Files of the kernel are tested by pictures that are rendered uncompiled; do not mix them with files of shapes.
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
from minirt.rendering.threads import usable_cores
from minirt.scene import Scene
from tests.kernel import pictures
from tests.paths import PACKAGE
from tests.shapes.execution_modes import on_arrays
from tests.stability.mutations import Change, changes
from tests.stability.regime import posed
from tests.stability.table import REGIMES

SHARED = ("quadric", "compensated", "flat_start", "basis", "bounds")  # files that several shapes use
TOPICS = {"uv_mapping": "mapping", "cone_start": "cone"}  # file -> the word in the names of its tests, if another
FILES = (*SHARED, *TOPICS, "pyramid", *(kind.element.__module__.rpartition(".")[2] for kind in minirt.shapes.ALL_KINDS))
TESTS = (
    "tests/shapes",
    *(f"tests/stability/test_{name}.py" for name in ("certificates", "surfaces", "properties")),
)
# Tests that start threads cannot run after a fork.
UNFIT = "not traced and not compiled and not reintersection and not pictures and not mutants and not length_of"
KERNEL = {"trace": "kernel/trace.py", "shadow_rays": "kernel/shadow_rays.py", "shade": "kernel/shading/shade.py"}
PICTURES = (
    *(f"tests/kernel/test_{name}.py" for name in ("coincident", "extremes", "invariances")),
    *(f"tests/kernel/shading/test_{name}.py" for name in ("lights", "specular", "whitted")),
    "tests/stability/test_pictures.py",
    "tests/rendering/packing/test_visibility.py",
)
COMPILED = "not compiled and not every_scene and not many_shapes and not light_is_finite and not lists_begin"
SECONDS = 120  # limit for a change, which may make a loop endless


def main(names: list[str]) -> int:
    """Print the surviving changes, and return whether there are any."""
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
    """Run the tests of some files; return 0 if all pass."""
    if set(names) <= set(KERNEL):
        pictures.picture = interpreted
        return int(pytest.main([*PICTURES, "-x", "-q", "-p", "no:cacheprovider", "-k", COMPILED]))
    own = [f"tests/shapes/test_{name}.py" for name in names]  # first, since they are most likely to fail
    topics = " or ".join(TOPICS.get(name, name) for name in names)
    chosen = UNFIT if set(names) & set(SHARED) else f"{UNFIT} and ({topics})"
    return int(pytest.main([*filter(os.path.exists, own), *TESTS, "-x", "-q", "-p", "no:cacheprovider", "-k", chosen]))


def interpreted(scene: Scene, width: int = 24, height: int = 16, samples: int = 1, renderer: object = None) -> Any:
    """Render a picture as `tests.kernel.pictures.picture` does, but without the compiler."""
    return preview.render_interpreted(scene, width, height)


def path_of(name: str) -> str:
    """Return the path of a file in the package."""
    return KERNEL.get(name, f"shapes/{name}.py")


def fails(name: str) -> bool:
    """Test whether a regime fails, which finds most changed formulas at once."""
    rights = [posed(regime) for kind, regime in REGIMES if name in SHARED or kind.element.__module__.endswith(name)]
    return any(any(right.errors(on_arrays(*right.rays))) for right in rights)


def tried(name: str, change: Change) -> int:
    """Fork a process that runs the tests with a change and exits with 0 if they all pass; return its number."""
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
    """Wait for the next process to end; return whether its change passed all tests or ran out of time."""
    process, status = os.wait()
    name, change = running.pop(process)
    late = " (too slow)" if os.WIFSIGNALED(status) else ""
    if status == 0 or late:
        print(f"minirt/{path_of(name)}:{change.line}: {change.before}  ->  {change.after}{late}", flush=True)
    return status == 0


def put(module: ModuleType, change: Change) -> None:
    """Replace the functions and constants of a module by the changed ones."""
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
    """Return the modules of the package that import a constant of a module, and the module itself."""
    imports = f"from {module.__name__} import "
    found = [each for each in sys.modules.values() if each.__name__.startswith("minirt.") and hasattr(each, name)]
    return [each for each in found if each is module or imports in Path(str(each.__file__)).read_text()]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
