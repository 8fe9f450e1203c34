"""The tests run alike in every environment: in a read-only home, for other processors, with Ctrl+C ignored."""

from __future__ import annotations

import os
import platform
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from minirt.kernel.machine_code import compile_process
from tests import conftest, environment, scheduling
from tests.lines import next_line
from tests.paths import ROOT
from tests.processes import run, started
from tests.waiting import HANG_LIMIT

# Prints the kinds of vector registers that a compiled sum of lanes uses.
REGISTERS = """
import re
import numpy as np
from numba import njit
from minirt.kernel.compiler import object_code
from minirt.kernel.compiler.pipeline import FLAGS
from minirt.lanes import load, save, width

def double(x):
    for i in range(0, len(x), width(x)):
        save(load(x, i) + load(x, i), x, i)

compiled = njit(**FLAGS)(double)
compiled.compile("(float64[::1],)")
(code,) = compiled.inspect_asm().values()
print(*set(re.findall("%?([xyz]mm)[0-9]", code)))
"""
CHILD = [sys.executable, "-c", "import signal; signal.pause()"]
PARENT = f"""
import signal, subprocess
child = subprocess.Popen({CHILD}, close_fds=False)
print("both run", flush=True)
signal.pause()
"""


def prepared(monkeypatch: pytest.MonkeyPatch, **variables: str) -> dict[str, str]:
    """Return these environment variables as `prepare` completes them."""
    monkeypatch.setattr(os, "environ", variables)
    environment.prepare()
    for name in ("XDG_STATE_HOME", "XDG_CONFIG_HOME"):  # journals and defaults of tests are not the user's
        assert variables.pop(name).startswith(str(ROOT / "out"))
    return variables


def test_kernels_are_cached_in_the_folder_of_the_user(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    assert prepared(monkeypatch, XDG_CACHE_HOME=str(tmp_path)) == {"XDG_CACHE_HOME": str(tmp_path)}
    monkeypatch.setattr(Path, "home", lambda: tmp_path / "me")
    assert prepared(monkeypatch) == {}
    assert list(tmp_path.iterdir()) == [tmp_path / "me"]


def test_kernels_are_cached_beside_the_sources_if_that_folder_cannot_be_written(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "file").touch()
    instead = {"XDG_CACHE_HOME": str(ROOT / "out" / "cache")}
    assert prepared(monkeypatch, XDG_CACHE_HOME=str(tmp_path / "file")) == instead

    def homeless() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setattr(Path, "home", homeless)
    assert prepared(monkeypatch) == instead


@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="names processors of x86-64")
def test_a_named_processor_has_its_own_features_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """In the code that tests compile, and in that of the process that compiles kernels."""
    variables = {name: value for name, value in os.environ.items() if not name.startswith("NUMBA_")}
    for name, has, lacks in (("x86-64-v4", "zmm", "none"), ("x86-64-v3", "ymm", "zmm"), ("generic", "xmm", "ymm")):
        with monkeypatch.context() as patch:
            named = prepared(patch, **variables, NUMBA_CPU_NAME=name)
        for settings in (named, compile_process.environment(name)):
            done = run([sys.executable, "-c", REGISTERS], env=settings, text=True)
            assert has in done.stdout.split(), (name, done.stderr)
            assert lacks not in done.stdout.split()


def test_features_that_the_environment_names_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    chosen = {"NUMBA_CPU_NAME": "haswell", "NUMBA_CPU_FEATURES": "+avx"}
    assert {**prepared(monkeypatch, **chosen), **chosen} == prepared(monkeypatch, **chosen)
    assert "NUMBA_CPU_FEATURES" not in prepared(monkeypatch)
    assert "NUMBA_CPU_FEATURES" not in prepared(monkeypatch, NUMBA_CPU_NAME="")


def test_ctrl_c_reaches_the_tests_if_the_caller_ignores_it() -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        conftest.pytest_configure()
        with started([sys.executable, "-c", "import sys; print('ready', flush=True); sys.stdin.read()"],
                     stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:  # fmt: skip
            next_line(process)
            process.send_signal(signal.SIGINT)
            assert process.communicate(timeout=HANG_LIMIT)[0] == b""
        assert process.returncode == -signal.SIGINT
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_program_whose_block_fails_leaves_nothing_running() -> None:
    """Parent and child hold one end of a pipe; the other end sees when both are gone."""
    reader, writer = os.pipe()

    def failing_block() -> None:
        with started([sys.executable, "-c", PARENT], stdout=subprocess.PIPE, pass_fds=(writer,)) as parent:
            next_line(parent)
            os.close(writer)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        failing_block()
    with os.fdopen(reader, "rb") as file:
        assert file.read() == b""


def test_windows_and_scenes_are_groups_and_every_other_file_is_its_own() -> None:
    walk, file = "tests/viewer/app/test_walk.py::test_a_walk", Path(__file__).relative_to(ROOT).as_posix()
    assert scheduling.work_group(walk) == scheduling.work_group("tests/mlx/test_window.py::test_x[a]") == "windows"
    assert {scheduling.work_group(f"{each}::test_y") for each in scheduling.SCENE_TESTS} == {"scenes"}
    assert all((ROOT / each).is_file() for each in scheduling.SCENE_TESTS)
    assert scheduling.work_group(f"{file}::test_z[b::c]") == file
    tests = [f"{file}::test_z", "tests/test_goldens.py::test_y", walk]
    assert sorted(tests, key=scheduling.order) == tests[::-1]


def test_what_quick_leaves_out_exists() -> None:
    for each in scheduling.SLOW:
        assert (ROOT / each).is_dir() if each.endswith("/") else (ROOT / each).is_file()
