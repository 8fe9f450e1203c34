"""Compiling in another process: its kernels run here, its errors are reported, and none is left behind."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest

from minirt.errors import RenderError
from minirt.kernel.machine_code import cache_folder, compile_process, loader
from minirt.kernel.machine_code.compile_process import CompileProcess, environment
from minirt.kernel.machine_code.processor import NATIVE, V3, V4
from tests.guards import must_end
from tests.kernel.machine_code.package_copies import copy_package
from tests.kernel.machine_code.small_kernels import call, count, double, half, library, square
from tests.lines import next_line
from tests.paths import PACKAGE, ROOT
from tests.processes import run, started
from tests.waiting import HANG_LIMIT, until

SCENE = "A 1 255,255,255\nC 0,0,0 0,0,1 60\nsp 0,0,5 4 10,20,30\n"
PREPARE = """
import sys
import minirt
from minirt.kernel.machine_code.library import LIBRARY
from minirt.rendering import Renderer
import numpy as np

sys.path.append("")
renderer, scene, pixels = Renderer(1), minirt.load("ball.rt"), np.zeros((8, 8, 4), np.uint8)
renderer.prepare(scene)
assert renderer.is_ready(scene)
prepared = len(LIBRARY.entries)
assert renderer.render(scene, pixels)
asked = renderer.kernels.compile_process.process is not None
print(len(LIBRARY.entries) - prepared, asked)
print(pixels[4, 4].tolist())
"""
PROGRAM = """
import subprocess, sys
command, request = sys.argv[1:]
child = subprocess.Popen([sys.executable, "-c", command, "--patient"], stdin=subprocess.PIPE)
child.stdin.write(request.encode() + b"\\n")
child.stdin.flush()
child.wait()
"""
ENDLESS = """
import os
from threading import Event
from minirt.kernel.compiler import object_code, process

def endless(function, signatures):
    print("compiling", function, signatures, os.nice(0), flush=True)
    Event().wait()

object_code.object_code = endless
process.main()
"""
# Stands for the compiler: writes something to standard error, an empty kernel for each request, and ends.
STAND_IN = """
import json, sys
from minirt.kernel.machine_code import container
requests = json.loads(sys.stdin.buffer.readline())
sys.stderr.write({errors})
for each in requests:
    sys.stdout.buffer.write(container.pack(b"", each, {{}}, b"code"))
"""


def stand_in(monkeypatch: pytest.MonkeyPatch, program: str) -> None:
    """Let another program compile."""
    monkeypatch.setattr(compile_process, "COMMAND", (sys.executable, "-c", program))


def prepared(folder: Path, place: Path, package: Path = PACKAGE) -> list[str]:
    """Prepare for a scene in a new process and return what it prints: how many kernels the picture needed beyond those
    that were prepared, whether another process was asked to compile, and a pixel."""
    (folder / "ball.rt").write_text(SCENE)
    command = [sys.executable, "-P", "-W", "error", "-c", PREPARE]
    variables = os.environ | {"XDG_CACHE_HOME": str(place), "PYTHONPATH": str(package.parent)}
    done = run(command, cwd=folder, env=variables, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    lines: list[str] = done.stdout.split("\n")
    return lines


def test_another_process_compiles_all_that_a_picture_needs_and_the_next_program_finds_it(tmp_path: Path) -> None:
    (tmp_path / "numba.py").write_text("raise SystemExit('a module of the current folder was imported')")
    package, place = copy_package(tmp_path / "copy"), tmp_path / "cache"
    assert prepared(tmp_path, place, package)[:2] == ["0 True", "[30, 20, 10, 255]"]
    assert prepared(tmp_path, place, package)[:2] == ["0 False", "[30, 20, 10, 255]"]


def test_two_programs_may_compile_at_once(tmp_path: Path) -> None:
    package = copy_package(tmp_path)
    with ThreadPoolExecutor(2) as pool:
        printed = list(pool.map(lambda _: prepared(tmp_path, tmp_path / "cache", package), range(2)))
    assert [each[1] for each in printed] == ["[30, 20, 10, 255]"] * 2
    assert prepared(tmp_path, tmp_path / "cache", package)[0] == "0 False"


def test_one_process_compiles_several_kernels_in_their_order(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    started_processes: list[Any] = []
    popen = subprocess.Popen
    monkeypatch.setattr(
        subprocess, "Popen", lambda *args, **options: started_processes.append(args) or popen(*args, **options)
    )
    kernels = library(None)
    requests = [kernels.identity(call(each)) for each in (square, count, double)]
    codes = CompileProcess(patient=True).compile(requests)
    values = np.array([3.0])
    results = [loader.load(*each)(values) for each in codes]
    assert (results, values.tolist()) == ([None, 41, None], [18.0])
    (arguments,) = started_processes
    assert arguments[0][-1] == "--patient"
    assert CompileProcess().compile([]) == []
    assert "--patient" not in started_processes[1][0]


def test_compiling_for_another_processor_gives_other_code(monkeypatch: pytest.MonkeyPatch) -> None:
    kernels = library(None)
    request = kernels.identity(call(double))
    (one,), (same,), (other,) = (CompileProcess().compile([request], each) for each in ("generic", "generic", V3))
    assert one == same
    assert one != other


@pytest.mark.parametrize(
    ("code", "reason"),
    [
        ("import sys; sys.stdin.buffer.readline(); raise MemoryError('no room')", "MemoryError: no room"),
        ("import os; os._exit(3)", "the compiler ended with status 3"),
        ("import os; os.close(0); os._exit(3)", "the compiler ended with status 3"),
        ("print('text')", "what the compiler wrote is damaged, it is too short"),
        ("print('text' * 99)", r"what the compiler wrote is damaged, it has (?s:.*)"),
    ],
)
def test_the_reason_of_a_failure_is_reported(monkeypatch: pytest.MonkeyPatch, code: str, reason: str) -> None:
    stand_in(monkeypatch, code)
    with pytest.raises(RenderError, match=f"^the kernel cannot be compiled: {reason}$"):
        CompileProcess().compile(["a request"])


def test_the_reason_why_a_function_cannot_be_compiled_is_reported() -> None:
    kernels = library(None)
    with pytest.raises(RenderError, match=r"^the kernel cannot be compiled: TypeError: a kernel returns integers"):
        kernels.compile([kernels.identity(call(half))], CompileProcess())


def test_a_compiler_that_cannot_be_started_is_an_error(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(compile_process, "COMMAND", (str(tmp_path / "nothing"),))
    with pytest.raises(RenderError, match=r"^the compiler cannot be started: .*nothing"):
        CompileProcess().compile(["a request"])


@pytest.mark.skipif(sys.platform == "win32", reason="there are no alarms")
def test_any_amount_of_messages_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """More than a pipe holds."""
    stand_in(monkeypatch, STAND_IN.format(errors="'a warning' * 200_000"))
    with must_end():
        assert CompileProcess().compile(["one", "two"]) == [({}, b"code")] * 2


def test_a_notice_is_told_once_and_other_messages_are_not(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(cache_folder, "TOLD", set())
    stand_in(monkeypatch, STAND_IN.format(errors=repr("a warning: 100%s\nnotice: it is 100%s slow\n")))
    for _ in range(2):
        CompileProcess().compile(["a request"])
    assert caplog.messages == ["notice: it is 100%s slow"]


@pytest.mark.parametrize(
    ("target", "chosen"),
    [
        (V4, {"NUMBA_CPU_NAME": V4, "NUMBA_CPU_FEATURES": "+avx512f"}),
        (V3, {"NUMBA_CPU_NAME": V3, "NUMBA_CPU_FEATURES": ""}),
        ("generic", {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}),
        (NATIVE, {}),
    ],
)
def test_settings_for_other_uses_of_numba_do_not_reach_the_compiler(
    monkeypatch: pytest.MonkeyPatch, target: str, chosen: dict[str, str]
) -> None:
    for name in ("DISABLE_JIT", "NUM_THREADS", "CPU_NAME", "CPU_FEATURES", "OPT", "DEBUG", "CACHE_DIR"):
        monkeypatch.setenv(f"NUMBA_{name}", "1")
    monkeypatch.setenv("OTHER", "1")
    made = environment(target)
    assert {name: value for name, value in made.items() if name.startswith("NUMBA")} == {
        "NUMBA_DISABLE_JIT": "0",
        **chosen,
    }
    assert made["OTHER"] == "1"
    assert made["PYTHONPATH"].split(os.pathsep) == [each or os.curdir for each in sys.path]


def test_stop_ends_the_process(monkeypatch: pytest.MonkeyPatch) -> None:
    stand_in(monkeypatch, "import sys; sys.stdin.read()")  # waits for ever
    errors: list[RenderError] = []
    compiling = CompileProcess()
    compiling.stop()  # no process yet

    def compile() -> None:
        with pytest.raises(RenderError) as caught:
            compiling.compile(["a request"])
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
def test_a_patient_process_has_the_lowest_priority_and_ends_when_the_program_is_killed(tmp_path: Path) -> None:
    """The process waits for ever instead of compiling, so nothing else could end it."""
    request = json.dumps([json.dumps(["module:name", ["int"], "fingerprint"])])
    variables = os.environ | {"XDG_CACHE_HOME": str(tmp_path), "PYTHONPATH": str(PACKAGE.parent)}
    command = [sys.executable, "-c", PROGRAM, ENDLESS, request]
    with started(command, env=variables, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as program:
        assert next_line(program) == "compiling module:name ['int'] 19"
        os.kill(program.pid, signal.SIGKILL)
        assert program.communicate(timeout=HANG_LIMIT)[0] == b""  # the compiler, which inherited it, has ended too
