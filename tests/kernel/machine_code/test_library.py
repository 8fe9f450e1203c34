"""The library of kernels: what is in memory, what is on disk, and what must be compiled."""

from __future__ import annotations

import gc
import weakref
from contextlib import nullcontext
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest

from minirt.errors import RenderError
from minirt.kernel.machine_code import cache
from minirt.kernel.machine_code import library as library_module
from minirt.kernel.machine_code.cache import CodeCache
from minirt.kernel.machine_code.fingerprint import processor
from minirt.kernel.machine_code.library import Call, Entry, Library
from tests.kernel.machine_code import small_kernels
from tests.kernel.machine_code.small_kernels import Compiler, call, count, double, is_found, library, square

DOUBLE, SQUARE, COUNT = call(double), call(square), call(count)


class Failing(Compiler):
    """Compiles nothing."""

    def compile(self, requests: list[str], target: str | None = None) -> Any:
        raise RenderError("no room")


def found(kernels: Library, wanted: Call) -> Entry | None:
    """Return the kernel for a call; None where it must be compiled."""
    return kernels.find(kernels.identity(wanted))


def compiled_by(kernels: Library, *calls: Any) -> int:
    """Ask a library for some kernels; return how many were compiled."""
    compiler, identities = Compiler(), list(map(kernels.identity, calls))
    kernels.compile(identities, compiler)
    assert all(map(kernels.find, identities))
    return len(compiler.compiled)


def test_a_kernel_is_compiled_once_and_found_by_the_next_library(tmp_path: Path) -> None:
    kernels = library(tmp_path)
    assert found(kernels, DOUBLE) is None
    assert compiled_by(kernels, DOUBLE) == 1
    assert found(kernels, DOUBLE) is found(kernels, DOUBLE) is kernels.get(DOUBLE)
    assert compiled_by(kernels, SQUARE, DOUBLE, COUNT, SQUARE) == 2
    assert compiled_by(library(tmp_path), DOUBLE, SQUARE) == 0
    assert compiled_by(library(None), DOUBLE) == 1


def test_kernels_in_memory_are_limited_to_those_that_were_used_last(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(library_module, "IN_MEMORY", 2)
    kernels = library(tmp_path)
    assert compiled_by(kernels, DOUBLE) == compiled_by(kernels, SQUARE) == 1
    double_entry, square_entry = found(kernels, DOUBLE), found(kernels, SQUARE)
    assert found(kernels, DOUBLE) is double_entry  # so that the other one was not used for longest
    assert compiled_by(kernels, COUNT) == 1
    assert len(kernels.entries) == 2
    assert found(kernels, DOUBLE) is double_entry
    assert found(kernels, SQUARE) not in (None, square_entry), "loaded from disk again"
    values = np.array([3.0])
    square_entry(values)
    assert values == [9.0], "whoever has a kernel may go on to call it"
    without_disk = library(None)
    assert compiled_by(without_disk, DOUBLE, SQUARE, COUNT) == 3
    assert compiled_by(without_disk, DOUBLE, SQUARE, COUNT) == 0


def test_programs_that_compile_the_same_kernels_lock_each_once_in_the_same_order(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else each of two programs could hold a lock that the other waits for."""
    calls, locked = [DOUBLE, SQUARE, COUNT, DOUBLE], list[str]()
    monkeypatch.setattr(CodeCache, "compiling_once", lambda _, identity: nullcontext(locked.append(identity)))
    for i, each in enumerate((calls, calls[::-1], calls[2:] + calls[:2])):
        kernels = library(tmp_path / str(i))
        kernels.compile(map(kernels.identity, each), Compiler())
    assert locked == locked[:3] * 3
    assert len(set(locked)) == 3


def test_threads_that_need_the_same_kernel_compile_it_once(tmp_path: Path) -> None:
    kernels, compiler = library(tmp_path), Compiler()
    identities = kernels.identity(DOUBLE), kernels.identity(SQUARE)
    threads = [Thread(target=kernels.compile, args=(identities, compiler)) for _ in range(4)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert len(compiler.compiled) == 2


@pytest.mark.parametrize("folder", [True, False])
def test_a_failure_is_reported_and_leaves_nothing_behind(tmp_path: Path, folder: bool) -> None:
    kernels = library(tmp_path if folder else None)
    with pytest.raises(RenderError, match=r"^no room$"):
        kernels.compile([kernels.identity(DOUBLE)], Failing())
    assert found(kernels, DOUBLE) is None
    assert not list(tmp_path.glob("*.kernel"))
    assert compiled_by(kernels, DOUBLE) == 1, "nothing is locked"


def is_freed_with_its_last_reference(kernels: Library) -> bool:
    """Whether the machine code of a kernel lives as long as it may be called, and no longer."""
    entry = small_kernels.compiled(kernels, DOUBLE, Compiler())
    code = weakref.ref(entry.code)
    kernels.entries.clear()
    gc.collect()
    values = np.array([1.5])
    entry(values)
    assert values == [3.0]
    assert code() is not None
    del entry
    gc.collect()
    return code() is None


def test_the_memory_of_a_kernel_is_freed_with_its_last_reference(tmp_path: Path) -> None:
    kernels = library(tmp_path)
    assert is_freed_with_its_last_reference(kernels)
    assert is_freed_with_its_last_reference(kernels), "loaded from disk"


def test_a_kernel_of_the_package_is_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cache, "SHIPPED", tmp_path)
    (tmp_path / processor()).mkdir()
    assert (is_found(double, tmp_path / processor()), is_found(double, None)) == (False, True)
    monkeypatch.setenv("NUMBA_CPU_NAME", "another")
    assert not is_found(double, None)


def test_any_number_of_signatures_needs_bounded_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(library_module, "REMEMBERED", 8)
    kernels = library(None)
    for ndim in range(1, 30):
        wanted = call(double, np.zeros((1,) * ndim))
        assert found(kernels, wanted) is None
        assert kernels.identity(wanted) == kernels.identity(wanted)
    assert len(kernels.identities) <= 8
    assert len(kernels.missing) <= 8
