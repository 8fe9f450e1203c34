"""Passing by reference: a compiled function reads and writes the same numbers as if arrays were passed by value."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest
from numba.core.errors import TypingError
from numba.extending import register_jitable

import minirt.kernel.compiler.object_code  # noqa: F401  (registers what is compiled)
from minirt.kernel.compiler.pipeline import INLINED
from minirt.kernel.trace import for_each_kind
from tests.kernel.machine_code.small_kernels import as_kernel

Array = np.ndarray[Any, Any]


class Inner(NamedTuple):
    line: Any
    number: int


class Outer(NamedTuple):
    table: Any
    deep: Any
    inner: Inner
    parts: Any
    absent: Any = None


def example() -> Outer:
    table, deep = np.arange(12.0).reshape(3, 4), np.arange(60).reshape(3, 4, 5)
    parts = Inner(np.array([2, 3, 5]), 7), Inner(np.array([11, 13]), 17)
    return Outer(table, deep, Inner(np.array([0.5, 0.25], np.float32), -3), parts)


def read(outer: Any, i: int, out: Array) -> None:
    out[0] = outer.table[i, 3] + outer.table[2, i]
    out[1] = outer.deep[i, 2, 4]
    out[2] = outer.deep[2, i][3]  # an item of a row
    out[3] = outer.inner.line[i] * outer.inner.number
    out[4] = outer.table.shape[0] * 100 + outer.table.shape[1] * 10
    out[5] = for_each_kind(weighted_sum, outer.parts, 1.0, i)


@register_jitable(**INLINED)
def weighted_sum(part: Inner, state: float, i: int) -> float:
    return 10.0 * state + part.line[i] * part.number


def write(table: Any, i: int) -> None:
    table[i, 2] = 41
    table[1][i] = table[i, 2] + 1


def checked(outer: Any) -> int:
    if outer.absent is not None and outer.absent[0] > 1:
        return int(outer.absent.unknown)
    if outer.table is None:
        return int(outer.table.unknown)
    return 7


@pytest.mark.parametrize("i", [0, 1])
def test_fields_rows_and_numbers_are_read(i: int) -> None:
    plain, compiled = np.zeros(6), np.zeros(6)
    read(example(), i, plain)
    as_kernel(read)(example(), i, compiled)
    assert np.array_equal(compiled, plain)
    assert len(set(plain.tolist())) == 6


@pytest.mark.parametrize("i", [0, 2])
def test_numbers_are_written_into_an_array(i: int) -> None:
    plain, compiled = np.zeros((3, 4)), np.zeros((3, 4))
    write(plain, i)
    as_kernel(write)(compiled, i)
    assert np.array_equal(compiled, plain)
    assert plain[i, 2] == 41
    assert plain[1, i] == 42


def test_no_code_is_compiled_for_a_field_that_is_none() -> None:
    assert as_kernel(checked)(example()) == 7
    with pytest.raises(TypingError):
        as_kernel(checked)(example()._replace(absent=np.ones(1)))
