"""Compiling in another process: its kernels run here, its errors are reported, and none is left behind."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest

from minirt.errors import RenderError
from minirt.kernel.machine_code import compile_process
from minirt.kernel.machine_code.cache import ObjectCode
from minirt.kernel.machine_code.compile_process import CompileProcess, environment
from minirt.kernel.machine_code.fingerprint import NATIVE, V3, V4
from minirt.kernel.machine_code.library import load
from tests.kernel.machine_code.small_kernels import call, count, double, library, square
from tests.paths import PACKAGE, ROOT
from tests.processes import next_line, started
from tests.waiting import HANG_LIMIT, until

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")
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
from minirt.kernel.compiler import main, object_code

def endless(function, signatures):
    print("compiling", function, signatures, os.nice(0), flush=True)
    Event().wait()

object_code.object_code = endless
main()
"""
# Stands for the compiler: writes something to standard error, an empty kernel for each request, and ends.
STAND_IN = """
import json, pickle, sys
from minirt.kernel.machine_code.cache import ObjectCode
requests = json.loads(sys.stdin.buffer.readline())
sys.stderr.write('a warning\\n' * 200_000)
pickle.dump([ObjectCode("f", b"code") for each in requests], sys.stdout.buffer)
"""
KILLED = """
import os, sys
for path in {}:
    if not os.path.exists(path):
        open(path, "x").close()
        os.kill(os.getpid(), 9)
sys.exit("the second one has compiled")  # an error whose message tells that
"""


def stand_in(monkeypatch: pytest.MonkeyPatch, program: str) -> None:
    """Let another program compile."""
    monkeypatch.setattr(compile_process, "COMMAND", (sys.executable, "-c", program))


def test_one_process_compiles_several_kernels_in_their_order(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """It imports nothing from the current folder."""
    (tmp_path / "numba.py").write_text("raise SystemExit('a module of the current folder was imported')")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    kernels = library(None)
    codes = CompileProcess().compile([kernels.identity(call(each)) for each in (square, count, double)])
    values = np.array([3.0])
    for each in codes:
        load(each)(values)
    assert values == [82.0]
    with pytest.raises(RenderError, match=r"^the kernel cannot be compiled: AttributeError: .* no attribute 'absent'"):
        kernels.compile([kernels.identity((f"{double.__module__}:absent", ()))], CompileProcess())


@pytest.mark.parametrize(
    ("code", "reason"),
    [
        ("import sys; sys.stdin.buffer.readline(); raise MemoryError('no room')", "MemoryError: no room"),
        ("import os; os.close(0); os._exit(3)", "the compiler ended with status 3"),
    ],
)
def test_the_reason_of_a_failure_is_reported(monkeypatch: pytest.MonkeyPatch, code: str, reason: str) -> None:
    stand_in(monkeypatch, code)
    with pytest.raises(RenderError, match=f"^the kernel cannot be compiled: {reason}$"):
        CompileProcess().compile(["a request"])
    monkeypatch.setattr(compile_process, "COMMAND", ("/nothing",))
    with pytest.raises(RenderError, match=r"^the compiler cannot be started: .*nothing"):
        CompileProcess().compile(["a request"])


@POSIX
@pytest.mark.parametrize(("kills", "reason"), [(1, "the second one has compiled"), (2, ".* ended with status -9")])
def test_a_compiler_that_is_killed_is_started_once_more(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, kills: int, reason: str
) -> None:
    stand_in(monkeypatch, KILLED.format([str(tmp_path / str(number)) for number in range(kills)]))
    with pytest.raises(RenderError, match=f"^the kernel cannot be compiled: {reason}$"):
        CompileProcess().compile(["a request"])
    assert len(list(tmp_path.iterdir())) == kills


def test_any_amount_of_messages_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """More than a pipe holds."""
    stand_in(monkeypatch, STAND_IN)
    assert CompileProcess().compile(["one", "two"]) == [ObjectCode("f", b"code")] * 2


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
    settings = {name: value for name, value in made.items() if name.startswith("NUMBA")}
    assert settings == {"NUMBA_DISABLE_JIT": "0", **chosen}
    assert made["OTHER"] == "1"
    assert made["PYTHONPATH"].split(os.pathsep) == [each or os.curdir for each in sys.path]


def test_stop_ends_the_process(monkeypatch: pytest.MonkeyPatch) -> None:
    stand_in(monkeypatch, "import sys; sys.stdin.read()")  # waits for ever
    errors: list[Any] = []
    compiling = CompileProcess()
    compiling.stop()  # no process yet

    def compile() -> None:
        with pytest.raises(RenderError) as caught:
            compiling.compile(["a request"])
        errors.append(caught.value)

    thread = Thread(target=compile, daemon=True)
    thread.start()
    until(lambda: compiling.process is not None, "the process")
    compiling.stop()
    thread.join(HANG_LIMIT)
    assert errors
    assert compiling.process is not None
    assert compiling.process.poll() is not None


@POSIX
def test_a_patient_process_has_the_lowest_priority_and_ends_when_the_program_is_killed(tmp_path: Path) -> None:
    """The process waits for ever instead of compiling, so nothing else could end it."""
    request = json.dumps([json.dumps(["module:name", ["int"], "fingerprint"])])
    variables = os.environ | {"XDG_CACHE_HOME": str(tmp_path), "PYTHONPATH": str(PACKAGE.parent)}
    command = [sys.executable, "-c", PROGRAM, ENDLESS, request]
    with started(command, env=variables, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as program:
        assert next_line(program) == "compiling module:name ['int'] 19"
        os.kill(program.pid, signal.SIGKILL)
        assert program.communicate(timeout=HANG_LIMIT)[0] == b""  # the compiler, which inherited it, has ended too
