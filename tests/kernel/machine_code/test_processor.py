"""The processor that kernels are compiled for: its level, and what makes kernels of two machines differ."""

from __future__ import annotations

import platform
import sys
from pathlib import Path

import pytest
from llvmlite import binding

from minirt.kernel.machine_code import processor
from minirt.kernel.machine_code.processor import NATIVE, NEEDED, V3, V4, cpu_flags, described, level, level_of

ALL_FLAGS = NEEDED[V3] | NEEDED[V4] | {"sse4_2", "popcnt", "avx512vnni"}
IS_X86_LINUX = sys.platform == "linux" and platform.machine() == "x86_64"
LLVM_NAMES = {"bmi1": "bmi", "abm": "lzcnt"}  # where LLVM has another name than Linux


@pytest.fixture(autouse=True)
def forget(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let each test find out the level anew, without a setting of the environment."""
    monkeypatch.delenv("NUMBA_CPU_NAME", raising=False)
    monkeypatch.setattr(processor, "level", processor.level.__wrapped__)


def test_the_highest_level_whose_flags_are_all_there_is_chosen() -> None:
    assert level_of(ALL_FLAGS) == V4
    assert level_of(NEEDED[V3]) == V3
    assert level_of(set()) == NATIVE
    for flag in NEEDED[V3]:
        assert level_of(ALL_FLAGS - {flag}) == NATIVE
    for flag in NEEDED[V4]:
        assert level_of(ALL_FLAGS - {flag}) == V3


@pytest.mark.skipif(not IS_X86_LINUX, reason="levels are of x86-64, flags from Linux")
def test_the_level_of_this_machine_is_that_which_llvm_sees() -> None:
    features = binding.get_host_cpu_features()
    seen = {flag for flag in NEEDED[V3] | NEEDED[V4] if features.get(LLVM_NAMES.get(flag, flag))}
    assert processor.level() == level_of(seen)
    assert seen <= cpu_flags()


def test_every_flag_of_a_level_is_known_to_llvm() -> None:
    """Misspelt, a flag would never be found, and every machine would compile at first use."""
    known = binding.get_host_cpu_features() if IS_X86_LINUX else {}
    if known:
        assert {LLVM_NAMES.get(flag, flag) for flag in NEEDED[V3] | NEEDED[V4]} <= set(known)


def test_other_systems_and_processors_have_no_level(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(processor, "cpu_flags", lambda: ALL_FLAGS)
    for system, machine, expected in (
        ("linux", "x86_64", V4),
        ("linux", "aarch64", NATIVE),
        ("darwin", "x86_64", NATIVE),
        ("win32", "AMD64", NATIVE),
    ):
        monkeypatch.setattr(sys, "platform", system)
        monkeypatch.setattr(platform, "machine", lambda machine=machine: machine)
        assert processor.level() == processor.processor() == expected


def test_the_flags_are_those_of_the_first_processor(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    path = tmp_path / "cpuinfo"
    monkeypatch.setattr(processor, "CPUINFO", path)
    assert cpu_flags() == set()
    path.write_text("processor\t: 0\nmodel name\t: Old: fast\nflags\t\t: fpu avx2\n\nprocessor\t: 1\nflags\t\t: none\n")
    assert cpu_flags() == {"fpu", "avx2"}
    assert processor.cpu_information("model name") == "Old: fast"
    path.write_bytes(b"flags\t: \xff avx2\n")
    assert "avx2" in cpu_flags()


def test_the_environment_may_name_a_processor(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CPU_NAME", "generic")
    assert processor.processor() == "generic"
    monkeypatch.setenv("NUMBA_CPU_NAME", "")
    assert processor.processor() == level()


def test_machines_that_need_different_code_have_different_descriptions(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """A level is the same on all machines; code for the very processor is of use on that processor alone."""
    texts = []
    for name in (V3, V4):
        monkeypatch.setattr(processor, "level", lambda name=name: name)
        texts.append(described(processor.processor()))
    monkeypatch.setattr(processor, "level", lambda: NATIVE)
    monkeypatch.setattr(processor, "CPUINFO", tmp_path / "cpuinfo")
    for model in ("one", "another"):
        (tmp_path / "cpuinfo").write_text(f"model name\t: {model}\n")
        texts.append(described(processor.processor()))
        assert model in texts[-1]
    assert len(set(texts)) == 4
    assert all(each.startswith(sys.platform) for each in texts)
