"""Object code: it refers to nothing outside of itself, so that no compiler is needed to load and run it."""

from __future__ import annotations

import json
import platform
import struct
import sys
from typing import Any

import numpy as np
import pytest
from llvmlite import binding

from minirt.kernel.compiler import object_code as object_code_module
from minirt.kernel.compiler.pipeline import FLAGS
from minirt.kernel.machine_code.arguments import signature_of
from minirt.kernel.machine_code.cache import ObjectCode
from minirt.kernel.machine_code.library import LIBRARY, load
from minirt.rendering import Renderer
from minirt.rendering.needed_kernels import calls_for, ray_query
from minirt.rendering.sampling.contrast import classify_call
from tests.kernel.machine_code.small_kernels import call, object_code_of
from tests.kernel.pictures import ALL

SYMBOL = struct.Struct("<IBBHQQ")  # of ELF for 64 bits: name, kind, visibility, section, value, size
ELF = pytest.mark.skipif(
    sys.platform != "linux" or platform.machine() not in ("x86_64", "aarch64"), reason="the object code is not ELF"
)


def quotients(x: Any, y: Any) -> None:
    for i in range(len(x)):
        y[i] = x[i] / y[i]


def step(x: Any, n: int) -> None:
    for i in range(0, len(x), n):
        x[i] = 1.0


def sine(x: Any) -> None:
    x[0] = np.sin(x[0])


def undefined_symbols(kernel: ObjectCode) -> set[str]:
    """Return the names that object code refers to and does not define."""
    sections = {each.name(): each.data() for each in binding.ObjectFileRef.from_data(kernel.code).sections()}
    names, found = sections[b".strtab"], set()
    for name, _, _, section, _, _ in SYMBOL.iter_unpack(sections[b".symtab"]):
        if name and not section:
            found.add(names[name : names.index(b"\0", name)].decode())
    return found


def code_of(function: Any, *arguments: Any) -> ObjectCode:
    """Return the object code of a small kernel."""
    name, values = call(function, *arguments)
    return object_code_of(name, json.dumps([signature_of(each) for each in values]))


@ELF
@pytest.mark.skipif(LIBRARY.cache is None, reason="kernels cannot be kept here")
def test_kernels_refer_to_nothing_outside_of_themselves() -> None:
    Renderer(1).kernels.compile(ALL)
    calls = [*calls_for(ALL, "double", 8), classify_call(), ray_query()]
    assert len({name for name, _ in calls}) > 3
    for each in calls:
        LIBRARY.get(each)
        kernel = LIBRARY.code(LIBRARY.identity(each))
        assert kernel
        assert undefined_symbols(kernel) == set(), each[0]
    assert undefined_symbols(code_of(quotients, np.zeros(1), np.zeros(1))) == set()


@ELF
def test_references_to_a_library_and_to_the_compiler_are_found() -> None:
    """To the compiler's for an error, as for a step of 0 of `range`."""
    assert "sin" in undefined_symbols(code_of(sine))
    assert "numba_unpickle" in undefined_symbols(code_of(step, np.zeros(9), 3))


def test_a_kernel_divides_as_ieee_754_says_and_keeps_nan() -> None:
    x = np.array([1.0, -1.0, 0.0, np.nan, 6.0])
    load(code_of(quotients, x, np.zeros(5)))(x, y := np.array([0.0, 0.0, 0.0, 1.0, -3.0]))
    assert np.array_equal(y, [np.inf, -np.inf, np.nan, np.nan, -2.0], equal_nan=True)


def test_the_entry_point_is_compiled_with_the_flags_of_the_kernel() -> None:
    """All of them but `nogil`: code for C never holds the lock of the interpreter."""
    assert {"nogil": True, **object_code_module.C_FLAGS} == FLAGS
