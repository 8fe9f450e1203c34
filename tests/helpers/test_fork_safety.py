"""Processes of users: after `os.fork()`, at any moment, a child process renders, traces and reads files.

`os.fork()` copies one thread alone. Locks that others held, and pools of threads, are of no use in the child process.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from threading import Event, Lock, Thread
from typing import Any
from weakref import WeakSet

import pytest

from minirt.helpers import system
from minirt.kernel.machine_code import library as library_module
from minirt.kernel.machine_code.library import Library
from minirt.rendering import renderer as renderers
from minirt.rendering.renderer import Renderer
from tests.cli.program import SCENE, environment
from tests.kernel.machine_code.small_kernels import Compiler, call, double, is_found, library
from tests.processes import in_child, run
from tests.waiting import HANG_LIMIT

pytestmark = [
    pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork"),
    pytest.mark.filterwarnings("ignore:.*multi-threaded:DeprecationWarning"),  # what Python 3.12 says of a fork
]

FORKED = """
import os, threading, numpy, minirt
from tests.waiting import until
scene = minirt.load("ball.rt")
rays = [[0, 0, -5]], [[0, 0, 1]]
before, hits = minirt.render(scene, 40, 30).array, minirt.trace(scene, *rays)
renderer = minirt.renderer(None)
def endless():
    renderer.render(scene, numpy.zeros((2000, 4000, 4), numpy.uint8), 65536)
thread = threading.Thread(target=endless)
thread.start()
until(lambda: renderer.runner.next_row.max() > 0 and renderer.busy.locked(), "the first row")
child = os.fork()
if not child:
    same = numpy.array_equal(minirt.render(scene, 40, 30).array, before)
    same &= minirt.trace(scene, *rays).distance == hits.distance
    os._exit(0 if same else 1)
status = os.waitpid(child, 0)[1]
assert thread.is_alive()
renderer.cancel()
thread.join()
assert status == 0
assert numpy.array_equal(minirt.render(scene, 40, 30).array, before)  # the parent goes on, too
"""


def run_script(folder: Path, source: str, *arguments: str) -> None:
    """Run a program in a folder with a scene and a file that is no scene; it must end without errors."""
    (folder / "ball.rt").write_text(SCENE)
    (folder / "bad.rt").write_text("nonsense\n")
    (folder / "program.py").write_text(source)
    settings = environment() | {"PYTHONWARNINGS": "ignore::DeprecationWarning"}
    ended = run([sys.executable, "program.py", *arguments], cwd=folder, env=settings, text=True)
    assert (ended.returncode, ended.stderr) == (0, "")


def test_a_child_renders_and_traces_that_was_forked_while_another_thread_rendered(tmp_path: Path) -> None:
    run_script(tmp_path, FORKED)


def holds_in_child(condition: Callable[[], bool]) -> bool:
    """Fork, and return whether a condition holds in the child process."""
    status = in_child(lambda: os._exit(2 if condition() else 3))
    assert status in (2, 3), "the condition could not be found out"
    return status == 2


def is_free(lock: Any) -> bool:
    """Whether nobody holds a lock; it is taken by that."""
    return bool(lock.acquire(blocking=False))


def test_the_lock_of_all_renderers_is_free_in_a_child(monkeypatch: pytest.MonkeyPatch) -> None:
    with renderers.lock:
        assert holds_in_child(lambda: is_free(renderers.lock.lock))
        assert renderers.lock.lock.locked()  # in the parent process nothing changes
        monkeypatch.setattr(system, "renewables", WeakSet())  # nothing is renewed: the check notices
        assert not holds_in_child(lambda: is_free(renderers.lock.lock))


def test_a_child_leaves_the_compiling_processes_to_its_parent() -> None:
    renderer = Renderer(1)
    compiling, background = renderer.kernels.compile_process, renderer.kernels.background
    assert holds_in_child(lambda: renderer.kernels.compile_process is not compiling)
    assert holds_in_child(lambda: renderer.kernels.background is not background)
    assert renderer.kernels.compile_process is compiling
    assert renderer.kernels.background is background


def forked_while_loading(kernels: Library, work: Callable[[], Any], monkeypatch: pytest.MonkeyPatch) -> bool:
    """Fork while a thread loads a kernel, which goes on until the fork is under way; return whether the child process
    finds the lock of the library free, and that LLVM loads nothing, as LLVM has a lock of its own."""
    loading, forking, llvm = Event(), Event(), Lock()

    def load(code: Any, load: Any = library_module.load) -> Any:
        with llvm:
            loading.set()
            forking.wait(HANG_LIMIT)
            return load(code)

    monkeypatch.setattr(library_module, "load", load)
    os.register_at_fork(before=forking.set)  # called before the hook of the library, which was registered earlier
    thread = Thread(target=work)
    thread.start()
    assert loading.wait(HANG_LIMIT)
    free = holds_in_child(lambda: is_free(llvm) and is_free(kernels.lock))
    thread.join()
    assert not kernels.lock.locked()
    return free


@pytest.mark.parametrize("kept", [True, False], ids=["found", "compiled"])
def test_a_fork_waits_for_a_thread_that_loads_a_kernel(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kept: bool
) -> None:
    if kept:
        is_found(double, tmp_path)
    kernels, compiler = library(tmp_path), Compiler()
    work = partial(kernels.compile, [kernels.identity(call(double))], compiler)
    assert forked_while_loading(kernels, work, monkeypatch)
    assert bool(compiler.compiled) != kept
