"""Fingerprint of kernels: the level of the processor, and all sources of a kernel in a fixed order."""

from __future__ import annotations

import os
import platform
import shutil
import sys
from pathlib import Path

import pytest
from llvmlite import binding

from minirt.kernel.machine_code import fingerprint
from minirt.kernel.machine_code.fingerprint import NATIVE, NEEDED, V3, V4, described, level_of, processor
from tests.paths import PACKAGE

ALL_FLAGS = NEEDED[V3] | NEEDED[V4] | {"sse4_2", "popcnt", "avx512vnni"}
LLVM_NAMES = {"bmi1": "bmi", "abm": "lzcnt"}  # where LLVM has another name than Linux


@pytest.fixture(autouse=True)
def forget(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let each test find out the level anew, without a setting of the environment."""
    monkeypatch.setenv("NUMBA_CPU_NAME", "")
    monkeypatch.setattr(fingerprint, "level", fingerprint.level.__wrapped__)


def test_the_highest_level_whose_flags_are_all_there_is_chosen() -> None:
    assert level_of(ALL_FLAGS) == V4
    assert level_of(NEEDED[V3]) == V3
    assert {level_of(ALL_FLAGS - {flag}) for flag in NEEDED[V3]} == {level_of(set())} == {NATIVE}
    assert {level_of(ALL_FLAGS - {flag}) for flag in NEEDED[V4]} == {V3}


@pytest.mark.skipif(not fingerprint.is_linux_on_x86_64(), reason="levels are of x86-64, flags from Linux")
def test_the_level_of_this_machine_is_that_which_llvm_sees() -> None:
    """Misspelt, a flag would never be found, and every machine would compile at first use."""
    features = binding.get_host_cpu_features()
    seen = {flag for flag in NEEDED[V3] | NEEDED[V4] if features[LLVM_NAMES.get(flag, flag)]}
    assert processor() == level_of(seen)


@pytest.mark.parametrize(
    ("system", "machine", "expected"),
    [("linux", "x86_64", V4), ("linux", "aarch64", NATIVE), ("darwin", "x86_64", NATIVE), ("win32", "AMD64", NATIVE)],
)
def test_only_linux_on_x86_64_has_levels(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, system: str, machine: str, expected: str
) -> None:
    """Code for the very processor is of use on its model alone. The environment may name another processor."""
    flags, cpuinfo = " ".join(sorted(ALL_FLAGS)), tmp_path / "cpuinfo"
    cpuinfo.write_bytes(f"model name\t: Old: fast\nflags\t\t: {flags} ".encode() + b"\xff\n\nflags\t\t: none\n")
    monkeypatch.setattr(fingerprint, "CPUINFO", cpuinfo)
    monkeypatch.setattr(sys, "platform", system)
    monkeypatch.setattr(platform, "machine", lambda: machine)
    assert processor() == expected
    assert ("Old: fast" in described(processor())) == (expected == NATIVE)
    assert described(V3).split() == [system, V3]
    cpuinfo.unlink()
    assert processor() == NATIVE
    monkeypatch.setenv("NUMBA_CPU_NAME", "generic")
    assert processor() == "generic"


@pytest.mark.parametrize("name", ["kernel/frame.py", "kernel/shading/new.py", "lanes/mathematics.py"])
def test_each_source_of_a_kernel_changes_the_fingerprint_and_nothing_else(
    monkeypatch: pytest.MonkeyPatch, name: str, tmp_path: Path
) -> None:
    """Not the order of the disk either."""

    def found() -> str:
        return fingerprint.fingerprint_of.__wrapped__(V3)

    before, scan = found(), os.scandir
    package = shutil.copytree(PACKAGE, tmp_path / "minirt", ignore=shutil.ignore_patterns("__pycache__", "*.kernel"))
    monkeypatch.setattr(fingerprint, "PACKAGE", package)
    monkeypatch.setattr(os, "scandir", lambda folder: list(scan(folder))[::-1])
    (package / "cli/__init__.py").write_text("")
    (package / "shapes/page.md").touch()
    assert found() == before
    with (package / name).open("a") as file:
        file.write("\n")
    assert found() != before
