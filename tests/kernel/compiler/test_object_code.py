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

import minirt
from minirt.kernel.compiler import object_code as object_code_module
from minirt.kernel.compiler.options import FLAGS
from minirt.kernel.machine_code import functions, loader
from minirt.kernel.machine_code.library import LIBRARY, Call
from minirt.kernel.machine_code.signature import signature_of
from minirt.rendering.frame_arguments import frame_arguments
from minirt.rendering.scene_packing import Packing
from tests.kernel.bvh.trees import random_rays, random_shapes
from tests.kernel.machine_code.small_kernels import both, call, double, object_code_of, quotients, sine
from tests.kernel.pictures import ALL, AMBIENT, EYE, picture

SYMBOL = struct.Struct("<IBBHQQ")  # of ELF for 64 bits: name, kind, visibility, section, value, size
ELF = pytest.mark.skipif(
    sys.platform != "linux" or platform.machine() not in ("x86_64", "aarch64"), reason="the object code is not ELF"
)


def undefined_symbols(code: bytes) -> set[str]:
    """Return the names that object code refers to and does not define."""
    sections = {each.name(): each.data() for each in binding.ObjectFileRef.from_data(code).sections()}
    names, found = sections[b".strtab"], set()
    for name, _, _, section, _, _ in SYMBOL.iter_unpack(sections[b".symtab"]):
        if name and not section:
            found.add(names[name : names.index(b"\0", name)].decode())
    return found


def code_of(function: Any, *arguments: Any) -> Any:
    """Return the names and the object code of a small kernel."""
    name, values = call(function, *arguments)
    return object_code_of(name, json.dumps([signature_of(each) for each in values]))


def calls_of_a_picture() -> list[Call]:
    """Render all kinds of shapes, trace rays among many shapes, and return the calls of all kernels for that."""
    found: list[Call] = []

    class Recorder:
        def __getattr__(self, name: str) -> Any:
            def run(*arguments: Any) -> Any:
                found.append(getattr(functions, name).call(*arguments))
                return getattr(functions, name)(*arguments)

            return run

    picture(ALL)
    arrays = Packing(Recorder()).pack(ALL, 24, 16)
    found.append(functions.frame.call(*frame_arguments(arrays, np.zeros((16, 24, 4), np.uint8))))
    random = np.random.default_rng(1)
    shapes = random_shapes(random, 100)
    scene = minirt.Scene((AMBIENT, EYE, *shapes))
    with pytest.MonkeyPatch.context() as patch:
        traced = functions.trace_rays.call
        patch.setattr(functions.trace_rays, "call", lambda *given: found.append(traced(*given)) or found[-1])
        minirt.trace(scene, *random_rays(random, shapes, 10))
    return found


@ELF
@pytest.mark.skipif(LIBRARY.cache is None, reason="kernels cannot be kept here")
def test_kernels_refer_to_nothing_outside_of_themselves() -> None:
    calls = {LIBRARY.identity(each): each[0].split(":")[1] for each in calls_of_a_picture()}
    assert {"frame", "project_all", "fill_bins", "trace_rays"} <= set(calls.values())
    assert LIBRARY.cache
    for identity in calls:
        found = LIBRARY.cache.read(identity)
        assert found
        assert undefined_symbols(found[1]) == set()
    assert all(undefined_symbols(code_of(each)[1]) == set() for each in (double, quotients))


@ELF
def test_a_reference_to_a_library_is_found() -> None:
    assert "sin" in undefined_symbols(code_of(sine)[1])


def test_a_kernel_divides_as_ieee_754_says_and_keeps_nan() -> None:
    x = np.array([1.0, -1.0, 0.0, np.nan, 6.0])
    loader.load(*code_of(quotients, x, np.zeros(5)))(x, y := np.array([0.0, 0.0, 0.0, 1.0, -3.0]))
    assert np.array_equal(y, [np.inf, -np.inf, np.nan, np.nan, -2.0], equal_nan=True)


def test_the_entry_point_is_compiled_with_the_flags_of_the_kernel() -> None:
    """Of which one is none for functions of C."""
    assert {"nogil": True, **object_code_module.ENTRY_FLAGS} == FLAGS


def test_the_names_say_where_a_kernel_begins_and_how_many_integers_it_returns() -> None:
    for function, arguments, results in ((double, (np.zeros(1),), 0), (both, (np.zeros(1), 2), 2)):
        names, code = code_of(function, *arguments)
        assert names == {"entry": names["entry"], "results": results}
        assert names["entry"].isascii()
        assert names["entry"].encode() in code
