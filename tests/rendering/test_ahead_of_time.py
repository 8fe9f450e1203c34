"""Compiling ahead of time: every generic kernel once, and none of older sources is left."""

from __future__ import annotations

import sys
from pathlib import Path
from threading import Lock

import pytest

from minirt.errors import RenderError
from minirt.kernel.machine_code.cache import CodeCache, ObjectCode
from minirt.kernel.machine_code.compile_process import CompileProcess
from minirt.kernel.machine_code.fingerprint import fingerprint_of
from minirt.kernel.machine_code.library import identity_of
from minirt.rendering import ahead_of_time
from minirt.rendering.needed_kernels import generic_call
from minirt.rendering.packing.generic_kernels import GENERIC_KERNELS

PROCESSOR = "x86-64-v3"
FUNCTIONS = 5  # that pack scenes


@pytest.fixture
def compiled(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Identities of the kernels that were compiled, by a compiler that makes no code."""
    done: list[str] = []
    lock = Lock()

    def compile(_self: CompileProcess, requests: list[str], target: str | None = None) -> list[ObjectCode]:
        assert target == PROCESSOR
        with lock:
            done.extend(requests)
        return [ObjectCode("entry", 0, each.encode()) for each in requests]

    monkeypatch.setattr(CompileProcess, "compile", compile)
    return done


def test_every_generic_kernel_is_compiled_once(compiled: list[str], tmp_path: Path) -> None:
    number = len(GENERIC_KERNELS) + FUNCTIONS + 2  # and the query for single rays, and contrast
    assert ahead_of_time.build(tmp_path, PROCESSOR) == number
    assert len(set(compiled)) == len(compiled) == number == len(list(tmp_path.iterdir()))
    for generic in GENERIC_KERNELS:
        identity = identity_of(*generic_call(generic), fingerprint_of(PROCESSOR))
        assert CodeCache(tmp_path).read(identity) == ObjectCode("entry", 0, identity.encode())
    assert ahead_of_time.build(tmp_path, PROCESSOR) == 0
    assert len(compiled) == number


def test_damaged_kernels_are_compiled_again_and_old_ones_deleted(compiled: list[str], tmp_path: Path) -> None:
    ahead_of_time.build(tmp_path, PROCESSOR)
    first, second, *_ = sorted(tmp_path.iterdir())
    first.write_bytes(first.read_bytes()[:-1])
    second.rename(tmp_path / "old.kernel")
    compiled.clear()
    assert ahead_of_time.build(tmp_path, PROCESSOR) == 2
    assert second.exists()
    assert not (tmp_path / "old.kernel").exists()


def test_an_error_is_told_and_leaves_no_file(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(*_: object) -> None:
        raise RenderError("no compiler")

    monkeypatch.setattr(CompileProcess, "compile", fail)
    monkeypatch.setattr(sys, "argv", ["ahead_of_time", PROCESSOR, "--folder", str(tmp_path)])
    assert ahead_of_time.main() == 1
    assert capsys.readouterr().err == "Error\nno compiler\n"
    assert list(tmp_path.rglob("*.kernel")) == []
