"""Argument blocks: a compiled function finds in the words what Python has put there."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from minirt.kernel.machine_code import argument_block, entry, loader
from minirt.kernel.machine_code.argument_block import words_of
from minirt.kernel.machine_code.entry import Entry
from minirt.kernel.machine_code.signature import signature_of
from tests.kernel.machine_code.small_kernels import (
    Compiler,
    Inner,
    Outer,
    both,
    call,
    compiled,
    count,
    double,
    half,
    library,
    object_code_of,
    read_back,
)

RECORD = np.dtype([("height", "<f8"), ("centre", "<f8", (3,))])


def arguments() -> tuple[Any, ...]:
    """Return an argument of each type, and a place for what is read."""
    deep = np.arange(24, dtype=np.int32).reshape(2, 3, 4)
    outer = Outer(np.arange(12.0).reshape(3, 4), deep, Inner(np.array([0.5, 0.25], np.float32), -3))
    records = np.array([(1.5, (2, 3, 9)), (2.5, (5, 6, 7))], RECORD)
    return -(2**62) - 1, outer, -0.1, records, None, np.zeros(11)


def loaded(function: Any, *values: Any) -> Entry:
    """Return a small kernel for some arguments, compiled in this process."""
    return compiled(library(None), call(function, *values), Compiler())


def reads_all(kernel: Entry) -> bool:
    """Whether a compiled function reads the same of all arguments as the interpreted one."""
    plain, compiled = arguments(), arguments()
    assert read_back(*plain) == plain[0]
    assert len(set(plain[-1].tolist())) == len(plain[-1])
    return bool(kernel(*compiled) == plain[0] and np.array_equal(compiled[-1], plain[-1]))


def test_every_argument_is_read_back() -> None:
    assert reads_all(loaded(read_back, *arguments()))


def test_floats_in_the_words_of_integers_would_be_found_here(monkeypatch: pytest.MonkeyPatch) -> None:
    def with_truncated_floats(values: Any) -> list[int]:
        return words_of(tuple(int(each) if isinstance(each, float) else each for each in values))

    kernel = loaded(read_back, *arguments())
    monkeypatch.setattr(entry, "words_of", with_truncated_floats)
    assert not reads_all(kernel)


def test_the_words_of_each_argument() -> None:
    table = np.zeros((3, 4))
    assert words_of(7) == words_of(np.int32(7)) == [7]
    assert words_of(True) == [1]
    assert words_of(None) == [0]
    assert words_of(1.0) == words_of(np.float64(1.0)) == [0x3FF0_0000_0000_0000]
    assert words_of(-0.0) == [-(2**63)]
    assert words_of(table) == [0, 0, 12, 8, table.ctypes.data, 3, 4, 32, 8]
    assert words_of(Inner(table, -1)) == words_of(table) + words_of(-1) == words_of((table, (), (-1,)))
    assert words_of(()) == []
    words = [1]
    argument_block.append_words(words, (2, 3))
    assert words == [1, 2, 3]


@pytest.mark.parametrize("array", [np.zeros((3, 4)).T, np.zeros(6)[::2], np.zeros((2, 4))[:, :3], np.zeros(3)[::-1]])
def test_arrays_that_are_not_contiguous_are_refused(array: Any) -> None:
    for value in (array, (array,), Inner(array, 1)):
        with pytest.raises(ValueError, match=r"^an array for a kernel must be C-contiguous$"):
            words_of(value)
    assert words_of(array.copy())


@pytest.mark.parametrize("array", [np.zeros(0), np.zeros((0, 3)), np.zeros((1, 4))[:, :], np.array(2.0)])
def test_empty_arrays_and_single_numbers_are_contiguous(array: Any) -> None:
    assert words_of(array)[2] == array.size


@pytest.mark.parametrize("number", [2**63, -(2**63) - 1])
def test_integers_of_more_than_64_bits_are_refused(number: int) -> None:
    kernel = loaded(both, np.zeros(2), 1)
    with pytest.raises(OverflowError):
        kernel(np.zeros(2), number)


def test_a_kernel_returns_nothing_an_integer_or_several() -> None:
    assert loaded(double, np.zeros(3))(np.zeros(3)) is None
    assert loaded(count, np.zeros(3))(np.zeros(3)) == 43
    assert loaded(both, np.zeros(3), 5)(np.zeros(3), 2**63 - 1) == (3, 1 - 2**63)


def test_a_result_that_is_no_integer_is_refused() -> None:
    with pytest.raises(TypeError, match=r"^a kernel returns integers of 64 bits or nothing, not float64$"):
        loaded(half, np.zeros(3))


def test_the_words_are_in_memory_while_a_kernel_runs_and_unchanged_by_it() -> None:
    values = np.zeros(3), 5
    words = words_of(values)
    before = words.copy()
    kernel = loaded(both, *values)
    assert [kernel.run(words) for _ in range(3)] == [(3, -5)] * 3
    assert words == before


def test_the_code_of_a_kernel_lives_as_long_as_its_entry() -> None:
    kernels = [loader.load(*object_code_of(*named(double))) for _ in range(2)]
    del kernels[0]
    values = np.array([1.5])
    kernels[0](values)
    assert values == [3.0]


def named(function: Any) -> tuple[str, str]:
    """Return the name of a small kernel and its signatures in JSON."""
    name, values = call(function)
    return name, json.dumps([signature_of(each) for each in values])
