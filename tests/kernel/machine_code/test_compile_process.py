"""Compiling in another process: its result is found in the cache, its errors are reported, and none is left behind."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Thread

import numpy as np
import pytest
from minirt.rendering.running.compile_process import CompileProcess

from minirt.errors import RenderError
from minirt.rendering.frame_arguments import frame_arguments
from minirt.rendering.running import compile_process
from minirt.rendering.scene_packing import Packing
from minirt.scene import Camera, Scene
from minirt.shapes.sphere import Sphere
from tests.kernel.machine_code.package_copies import copy_package
from tests.paths import PACKAGE
from tests.processes import run, started
from tests.waiting import HANG_LIMIT, until

SCENE = "A 1 255,255,255\nC 0,0,0 0,0,1 60\nsp 0,0,5 4 10,20,30\n"
SPHERE = Scene((Camera((0, 0, 0), (0, 0, 1), 60), Sphere((0, 0, 5), 4, (10, 20, 30))))
PREPARE = """
import sys
import minirt
from minirt.rendering import Renderer
from minirt.rendering.scene_packing import Packing
import numpy as np

sys.path.append("")
renderer, scene, pixels = Renderer(1), minirt.load("ball.rt"), np.zeros((8, 8, 4), np.uint8)
renderer.prepare(scene)
assert renderer.is_ready(scene)
assert renderer.render(scene, pixels)
stats = renderer.kernels.jit.kernel_for(Packing().pack(scene, 8, 8)).stats
asked = renderer.kernels.compile_process.process is not None
print(sum(stats.cache_hits.values()), sum(stats.cache_misses.values()), asked)
print(pixels[4, 4].tolist())
"""
PROGRAM = """
import subprocess, sys
command, arguments = sys.argv[1:]
child = subprocess.Popen([sys.executable, "-c", command], stdin=subprocess.PIPE)
child.stdin.write(bytes.fromhex(arguments))
child.stdin.flush()
child.wait()
"""
ENDLESS = """
from threading import Event
from minirt.kernel.compiler import jit, process

def endless(arguments):
    print("compiling", flush=True)
    Event().wait()

jit.compile = endless
process.main()
"""


def prepared(folder: Path, place: Path, package: Path = PACKAGE) -> list[str]:
    """Prepare for a scene in a new process and return what it prints: cache hits and misses, whether another process
    was asked to compile, and a pixel."""
    (folder / "ball.rt").write_text(SCENE)
    command = [sys.executable, "-P", "-W", "error", "-c", PREPARE]
    environment = os.environ | {"XDG_CACHE_HOME": str(place), "PYTHONPATH": str(package.parent)}
    done = run(command, cwd=folder, env=environment, text=True)
    assert done.returncode == 0, done.stderr
    lines: list[str] = done.stdout.split("\n")
    return lines


def test_another_process_compiles_and_the_next_program_finds_the_kernel(tmp_path: Path) -> None:
    (tmp_path / "numba.py").write_text("raise SystemExit('a module of the current folder was imported')")
    place = tmp_path / "cache"
    assert prepared(tmp_path, place)[:2] == ["1 0 True", "[30, 20, 10, 255]"]
    assert prepared(tmp_path, place)[:2] == ["1 0 False", "[30, 20, 10, 255]"]


def test_two_programs_may_compile_at_once(tmp_path: Path) -> None:
    package = copy_package(tmp_path)
    with ThreadPoolExecutor(2) as pool:
        printed = list(pool.map(lambda _: prepared(tmp_path, tmp_path / "cache", package), range(2)))
    assert [each[1] for each in printed] == ["[30, 20, 10, 255]"] * 2
    assert prepared(tmp_path, tmp_path / "cache", package)[0] == "1 0 False"


@pytest.mark.parametrize(
    ("code", "reason"),
    [
        ("import sys; sys.stdin.buffer.read(1); raise MemoryError('no room')", "MemoryError: no room"),
        ("import os; os._exit(3)", "the compiler ended with status 3"),
    ],
)
def test_the_reason_of_a_failure_is_reported(monkeypatch: pytest.MonkeyPatch, code: str, reason: str) -> None:
    monkeypatch.setattr(compile_process, "COMMAND", (sys.executable, "-c", code))
    with pytest.raises(RenderError, match=f"^the kernel cannot be compiled: {reason}$"):
        CompileProcess().compile(())


def test_nothing_is_done_if_no_process_can_be_started(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(compile_process, "COMMAND", (str(tmp_path / "nothing"),))
    CompileProcess().compile(())


def test_stop_ends_the_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        compile_process, "COMMAND", (sys.executable, "-c", "import sys; sys.stdin.read()")
    )  # waits for ever
    errors: list[RenderError] = []
    compiling = CompileProcess()
    compiling.stop()  # no process yet

    def compile() -> None:
        with pytest.raises(RenderError) as caught:
            compiling.compile(())
        errors.append(caught.value)

    thread = Thread(target=compile, daemon=True)
    thread.start()
    until(lambda: compiling.process is not None, "the process")
    assert thread.is_alive()
    compiling.stop()
    thread.join(HANG_LIMIT)
    assert errors
    assert compiling.process is not None
    assert compiling.process.poll() is not None


@pytest.mark.skipif(sys.platform == "win32", reason="kills as POSIX does")
def test_the_process_ends_when_the_program_is_killed(tmp_path: Path) -> None:
    """The process waits for ever instead of compiling, so nothing else could end it."""
    arguments = pickle.dumps(frame_arguments(Packing().pack(SPHERE, 1, 1), np.zeros((1, 1, 4), np.uint8)))
    environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path), "PYTHONPATH": str(PACKAGE.parent)}
    command = [sys.executable, "-c", PROGRAM, ENDLESS, arguments.hex()]
    with started(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as program:
        assert program.stdout is not None
        assert program.stdout.readline() == b"compiling\n"
        os.kill(program.pid, signal.SIGKILL)
        assert program.communicate(timeout=HANG_LIMIT)[0] == b""  # the compiler, which inherited it, has ended too
