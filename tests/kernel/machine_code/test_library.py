"""The library of kernels: what is in memory, what is on disk, and what must be compiled."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest

from minirt.errors import RenderError
from minirt.kernel.machine_code import library as library_module
from minirt.kernel.machine_code import private_files
from minirt.kernel.machine_code.code_cache import CodeCache
from minirt.kernel.machine_code.entry import Entry
from minirt.kernel.machine_code.library import Call, Library, identity_of
from tests.kernel.machine_code.small_kernels import Compiler, both, call, count, double, library, square

DOUBLE, SQUARE, COUNT = call(double), call(square), call(count)


def found(kernels: Library, wanted: Call) -> Entry | None:
    """Return the kernel for a call; None where it must be compiled."""
    return kernels.find(kernels.identity(wanted))


class Failing(Compiler):
    """Compiles nothing."""

    def compile(self, requests: list[str], target: str | None = None) -> Any:
        raise RenderError("no room")


def compiled_by(kernels: Library, *calls: Any) -> int:
    """Ask a library for some kernels; return how many were compiled."""
    compiler, identities = Compiler(), list(map(kernels.identity, calls))
    kernels.compile(identities, compiler)
    assert all(map(kernels.find, identities))
    return len(compiler.compiled)


def test_a_kernel_is_found_after_it_was_compiled_and_by_the_next_library(tmp_path: Path) -> None:
    kernels = library(tmp_path)
    assert found(kernels, DOUBLE) is None
    assert compiled_by(kernels, DOUBLE) == 1
    assert found(kernels, DOUBLE) is found(kernels, DOUBLE) is kernels.get(DOUBLE)
    assert compiled_by(kernels, DOUBLE) == 0
    assert compiled_by(library(tmp_path), DOUBLE) == 0
    assert compiled_by(library(None), DOUBLE) == 1


def test_only_what_is_missing_is_compiled_and_each_kernel_once(tmp_path: Path) -> None:
    kernels = library(tmp_path)
    assert compiled_by(kernels, SQUARE) == 1
    assert compiled_by(kernels, SQUARE, DOUBLE, COUNT, DOUBLE) == 2
    assert compiled_by(kernels) == 0


def test_calls_with_equal_signatures_share_a_kernel_and_no_others_do() -> None:
    kernels, names = Library(), "tests.kernel.machine_code.small_kernels:"
    one, other = call(both, np.zeros(2), 7), call(both, np.ones(5), np.int32(9))
    assert kernels.identity(one) == kernels.identity(other)
    arguments = (np.zeros(2), 7), (np.zeros((2, 1)), 7), (np.zeros(2, np.float32), 7), (np.zeros(2), 7.0)
    calls = [*((names + "both", each) for each in arguments), (names + "count", arguments[0])]
    assert len({kernels.identity(each) for each in calls}) == len(calls)
    assert identity_of(*one, "sources") != identity_of(*one, "other sources")


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


def test_kernels_that_cannot_be_loaded_again_stay_in_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(library_module, "IN_MEMORY", 1)
    kernels = library(None)
    assert compiled_by(kernels, DOUBLE, SQUARE, COUNT) == 3
    assert compiled_by(kernels, DOUBLE, SQUARE, COUNT) == 0


def locked_in_turn(kernels: Library, calls: list[Any], monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return the identities that a library locks while it compiles, in their order."""
    locked: list[str] = []
    compiling_once = CodeCache.compiling_once

    def lock(cache: CodeCache, identity: str) -> Any:
        locked.append(identity)
        return compiling_once(cache, identity)

    with monkeypatch.context() as patch:
        patch.setattr(CodeCache, "compiling_once", lock)
        kernels.compile(map(kernels.identity, calls), Compiler())
    return locked


def test_programs_that_compile_the_same_kernels_lock_them_in_the_same_order(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else each of two programs could hold a lock that the other waits for."""
    calls = [DOUBLE, SQUARE, COUNT, DOUBLE]
    orders = []
    for i, each in enumerate((calls, calls[::-1], calls[2:] + calls[:2])):
        folder = tmp_path / str(i)
        folder.mkdir(mode=0o700)
        orders.append(locked_in_turn(library(folder), each, monkeypatch))
    assert orders == [orders[0]] * 3
    assert len(set(orders[0])) == len(orders[0]) == 3


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


def test_a_call_that_no_kernel_can_take_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(TypeError, match="no kernel takes str"):
        library(tmp_path).identity((DOUBLE[0], ("text",)))


@pytest.mark.parametrize("fault", [private_files.read, None], ids=["unreadable", "none"])
def test_get_returns_a_kernel_that_works(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fault: Callable[..., Any] | None
) -> None:
    """Whether its file can be read or not."""
    monkeypatch.setattr(library_module, "CompileProcess", Compiler)
    kernels = library(tmp_path)
    if fault:
        kernels.get(DOUBLE)
        kernels.entries.clear()

        def fail(path: Path) -> bytes:
            raise PermissionError(path)

        monkeypatch.setattr(private_files, "read", fail)
    values = np.array([4.0])
    kernels.get(DOUBLE)(values)
    assert values == [8.0]


def test_any_number_of_signatures_needs_bounded_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(library_module, "REMEMBERED", 8)
    kernels = library(None)
    for ndim in range(1, 30):
        identity = kernels.identity(call(double, np.zeros((1,) * ndim)))
        assert kernels.find(identity) is None
        assert identity == kernels.identity(call(double, np.zeros((1,) * ndim)))
    assert len(kernels.identities) <= 8
    assert len(kernels.missing) <= 8
