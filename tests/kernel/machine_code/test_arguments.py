"""Arguments of kernels: a compiled function finds in the words what Python has put there, and signatures tell types."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from numba import typeof

from minirt.kernel.compiler.object_code import type_of
from minirt.kernel.machine_code.arguments import key_of, signature_of, words_of
from minirt.kernel.machine_code.library import Entry
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
)

RECORD = np.dtype([("height", "<f8"), ("centre", "<f8", (3,))])


def read_back(number: int, outer: Outer, factor: float, records: Any, nothing: None, out: Any) -> int:
    """Store a number of each argument and of each part of one."""
    out[0], out[1] = outer.table[1, 2], outer.deep[1, 2, 3]
    out[2], out[3] = outer.inner.line[1], outer.inner.number
    out[4], out[5] = number, factor
    out[6], out[7] = records.shape[0], 9 + outer.inner.line.shape[0]
    out[8], out[9] = outer.table.shape[0], outer.deep.shape[2]
    out[10] = outer.absent is None and nothing is None
    return number


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
    assert read_back(*plain) == loaded(read_back, *found)(*found) == plain[0]
    assert len(set(plain[-1].tolist())) == len(plain[-1])
    assert np.array_equal(found[-1], plain[-1])


@pytest.mark.parametrize("array", [np.zeros((3, 4)).T, np.zeros(6)[::2], np.zeros((2, 4))[:, :3], np.zeros(3)[::-1]])
def test_arrays_that_are_not_contiguous_are_refused(array: Any) -> None:
    for value in (array, (array,), Inner(array, 1)):
        with pytest.raises(ValueError, match=r"^an array for a kernel must be C-contiguous$"):
            words_of(value)
    assert [words_of(each)[2] for each in (np.zeros((0, 3)), np.zeros((1, 4))[:, :], np.array(2.0))] == [0, 4, 1]


def test_a_kernel_returns_nothing_an_integer_or_several() -> None:
    assert loaded(double, np.zeros(3))(np.zeros(3)) is None
    assert loaded(count, np.zeros(3))(np.zeros(3)) == 43
    kernel = loaded(both, np.zeros(3), 5)
    assert kernel(np.zeros(3), 2**63 - 1) == (3, 1 - 2**63)
    with pytest.raises(OverflowError):
        kernel(np.zeros(3), 2**63)
    with pytest.raises(TypeError, match=r"^a kernel returns integers of 64 bits or nothing, not float64$"):
        loaded(half, np.zeros(3))


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
