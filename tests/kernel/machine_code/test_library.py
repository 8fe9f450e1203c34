"""The library of kernels: what is in memory, what is on disk, what must be compiled, and how it is called."""

from __future__ import annotations

import gc
import json
import weakref
from contextlib import nullcontext
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest
from numba import typeof

from minirt.errors import RenderError
from minirt.kernel.compiler.object_code import type_of
from minirt.kernel.machine_code import cache
from minirt.kernel.machine_code import library as library_module
from minirt.kernel.machine_code.arguments import key_of, signature_of, words_of
from minirt.kernel.machine_code.cache import CodeCache
from minirt.kernel.machine_code.fingerprint import processor
from minirt.kernel.machine_code.library import Call, Entry, Library
from tests.kernel.machine_code.small_kernels import (
    Compiler,
    Inner,
    Outer,
    call,
    compiled,
    count,
    double,
    is_found,
    library,
    square,
)

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
    entry = compiled(kernels, DOUBLE, Compiler())
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


# Arguments: a compiled function finds in the words what Python has put there, and signatures tell types.


RECORD = np.dtype([("height", "<f8"), ("centre", "<f8", (3,))])


def read_back(number: int, outer: Outer, factor: float, records: Any, nothing: None, out: Any) -> None:
    """Store a number of each argument and of each part of one."""
    out[0], out[1] = outer.table[1, 2], outer.deep[1, 2, 3]
    out[2], out[3] = outer.inner.line[1], outer.inner.number
    out[4], out[5] = number, factor
    out[6], out[7] = records.shape[0], 9 + outer.inner.line.shape[0]
    out[8], out[9] = outer.table.shape[0], outer.deep.shape[2]
    out[10] = outer.absent is None and nothing is None


def arguments() -> tuple[Any, ...]:
    """Return an argument of each type, and a place for what is read."""
    deep = np.arange(24, dtype=np.int32).reshape(2, 3, 4)
    outer = Outer(np.arange(12.0).reshape(3, 4), deep, Inner(np.array([0.5, 0.25], np.float32), -3))
    records = np.array([(1.5, (2, 3, 9)), (2.5, (5, 6, 7))], RECORD)
    return -(2**62) - 1, outer, -0.1, records, None, np.zeros(11)


def loaded(function: Any, *values: Any) -> Entry:
    """Return a small kernel for some arguments, compiled in this process."""
    return compiled(library(None), call(function, *values), Compiler())


def test_every_argument_is_read_back() -> None:
    plain, found = arguments(), arguments()
    read_back(*plain)
    loaded(read_back, *found)(*found)
    assert len(set(plain[-1].tolist())) == len(plain[-1])
    assert np.array_equal(found[-1], plain[-1])


@pytest.mark.parametrize("array", [np.zeros((3, 4)).T, np.zeros(6)[::2], np.zeros((2, 4))[:, :3], np.zeros(3)[::-1]])
def test_arrays_that_are_not_contiguous_are_refused(array: Any) -> None:
    for value in (array, (array,), Inner(array, 1)):
        with pytest.raises(ValueError, match=r"^an array for a kernel must be C-contiguous$"):
            words_of(value)
    contiguous = np.zeros((0, 3)), np.zeros((1, 4))[:, :], np.array(2.0)
    assert [np.frombuffer(words_of(each), np.int64)[2] for each in contiguous] == [0, 4, 1]


def through_json(value: Any) -> Any:
    """Return the signature of a value as another process reads it."""
    return json.loads(json.dumps(signature_of(value)))


def test_every_type_of_argument_survives_json_and_has_a_key_of_its_own() -> None:
    records = np.zeros(1, [("a", "<f8")]), np.zeros(1, [("b", "<f8")]), np.zeros(1, [("a", "<f8", (3,)), ("c", "<i8")])
    arrays = [np.zeros(1), np.zeros((0, 1)), np.zeros(1, np.float32), np.zeros(1, np.int64), np.zeros(2, np.bool_)]
    tuples = [(), (1,), (1.0,), ((1,),), (None, 1), (1, None), Inner(None, 1), (np.zeros(1), 1), Inner((), Inner(1, 2))]
    values = [None, 1, 1.0, *arrays, *records, *tuples]
    assert [type_of(through_json(each)) for each in values] == list(map(typeof, values))
    assert len({json.dumps(signature_of(each)) for each in values}) == len(set(map(key_of, values))) == len(values)
    assert signature_of(np.int32(3)) == signature_of(True) == signature_of(3)
    assert signature_of(np.float64(3)) == signature_of(3.0)


@pytest.mark.parametrize("value", ["text", [1, 2], {1: 2}, 1j, np.float32(1), np.bool_(True), object(), np.zeros])
def test_what_no_kernel_takes_is_an_error(value: Any) -> None:
    for each in (value, (1, value), Inner(1, (value,))):
        with pytest.raises(TypeError, match=f"^no kernel takes {type(value).__name__}$"):
            signature_of(each)
