"""Compiler of kernels: complete code for just its scene, IEEE 754's rules, arrays by reference."""

from __future__ import annotations

import json
import platform
import struct
import sys
from functools import cache
from typing import Any

import numpy as np
import pytest
from llvmlite import binding
from numba.core.errors import TypingError
from numba.extending import register_jitable

from minirt.kernel.compiler.object_code import compiled_entry
from minirt.kernel.compiler.pipeline import INLINED
from minirt.kernel.frame import frame
from minirt.kernel.machine_code.arguments import signature_of
from minirt.kernel.machine_code.cache import ObjectCode
from minirt.kernel.machine_code.library import LIBRARY, load
from minirt.kernel.trace import for_each_kind
from minirt.lanes.mathematics import ATAN_HALF, PERIOD
from minirt.materials import Checker, Clouds
from minirt.rendering import ahead_of_time
from minirt.rendering.frame import frame_arguments
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene
from minirt.shapes import Plane, Sphere
from tests.kernel.machine_code.small_kernels import Inner, Outer, as_kernel, call, object_code_of
from tests.kernel.pictures import AMBIENT, EYE, LAMP, SHAPES
from tests.skipping import skip_incomplete

SYMBOL = struct.Struct("<IBBHQQ")  # of ELF for 64 bits: name, kind, visibility, section, value, size
ELF = pytest.mark.skipif(
    sys.platform != "linux" or platform.machine() not in ("x86_64", "aarch64"), reason="the object code is not ELF"
)


def quotients(x: Any, y: Any) -> None:
    for i in range(x.shape[0]):
        y[i] = x[i] / y[i]


def step(x: Any, n: int) -> None:
    for i in range(0, x.shape[0], n):
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
def test_kernels_refer_to_nothing_outside_of_themselves_but_the_library_of_c() -> None:
    """Those that were compiled ahead of time, at least the first of them."""
    calls = [call for group in ahead_of_time.calls() for call in group]
    kernels = [(call[0], kernel) for call in calls if (kernel := LIBRARY.code(LIBRARY.identity(call)))]
    if len({name for name, _ in kernels}) < 3:
        skip_incomplete("kernels are not compiled: make all")
    for name, kernel in kernels:
        assert undefined_symbols(kernel) <= {"memset"}, name  # clears what an outlined function returns
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


SQUARE_ROOT = "call <16 x double> @llvm.sqrt.v16f64"


def scene_of(*kinds: type[Any]) -> Scene:
    """Return a scene with all test shapes of some kinds."""
    return Scene((AMBIENT, EYE, LAMP, *(shape for shape in SHAPES if isinstance(shape, kinds))))


@cache
def code(scene: Scene) -> str:
    """Return the LLVM code of the kernel of a scene, compiled anew: a kernel from the cache shows none."""
    arguments = frame_arguments(Packing().pack(scene, 8, 8), np.zeros((8, 8, 4), np.uint8))
    return str(compiled_entry(frame, list(map(signature_of, arguments))).inspect_llvm())


def test_only_shapes_that_take_square_roots_add_them() -> None:
    planes, spheres = (code(scene_of(kind)).count(SQUARE_ROOT) for kind in (Plane, Sphere))
    assert planes < spheres


def test_texture_coordinates_and_noise_are_computed_where_a_scene_needs_them() -> None:
    plain = scene_of(Sphere)
    other = Scene((*plain.elements[:-1], plain.elements[-1].replace(checker=Checker(0.5), clouds=Clouds(1.0))))
    for number in (ATAN_HALF, 1.0 / PERIOD):
        constant = f"0x{np.float64(number).view(np.uint64):X}"
        assert [constant in code(each) for each in (plain, other)] == [False, True]


def test_contraction_is_the_only_fast_math_of_instructions() -> None:
    compiled = code(scene_of(Sphere))
    assert " contract " in compiled
    for forbidden in (" fast ", " nnan ", " ninf ", " nsz ", " arcp ", " reassoc ", " afn "):
        assert forbidden not in compiled


# Passing by reference: a compiled function reads and writes the same numbers as an interpreted one.


def example() -> Outer:
    table, deep = np.arange(12.0).reshape(3, 4), np.arange(60).reshape(3, 4, 5)
    parts = Inner(np.array([2, 3, 5]), 7), Inner(np.array([11, 13]), 17)
    return Outer(table, deep, Inner(np.array([0.5, 0.25], np.float32), -3), parts)


def read(outer: Any, i: int, out: Any) -> None:
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


def checked(outer: Any, out: Any) -> None:
    if outer.absent is not None and outer.absent[0] > 1:
        out[0] = outer.absent.unknown
    if outer.table is None:
        out[0] = outer.table.unknown
    out[0] += 7.0


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
    out = np.zeros(1)
    as_kernel(checked)(example(), out)
    assert out == [7.0]
    with pytest.raises(TypingError):
        as_kernel(checked)(example()._replace(absent=np.ones(1)), out)
