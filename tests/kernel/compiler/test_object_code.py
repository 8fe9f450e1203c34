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
from minirt.kernel.machine_code import functions, loader, shipped_code
from minirt.kernel.machine_code.library import LIBRARY, Call, Library
from minirt.kernel.machine_code.signature import signature_of
from minirt.rendering import Renderer
from minirt.rendering.kernels import generic_identity
from minirt.scene import Scene
from tests.kernel.bvh.trees import random_rays, random_shapes
from tests.kernel.machine_code.small_kernels import both, call, double, object_code_of, quotients, sine, step
from tests.kernel.pictures import ALL, AMBIENT, EYE

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


def is_complete(kernel: Any) -> bool:
    """Whether a kernel refers to nothing outside of itself; an image cannot."""
    names, code = kernel
    return "relocations" in names or not undefined_symbols(code)


def code_of(function: Any, *arguments: Any) -> Any:
    """Return the names and the object code of a small kernel."""
    name, values = call(function, *arguments)
    return object_code_of(name, json.dumps([signature_of(each) for each in values]))


def kernels_of_a_picture() -> dict[str, str]:
    """Render all kinds of shapes, also to an error, trace rays among many shapes, and return the identities of the
    kernels that were looked for, with the names of their functions."""
    found: dict[str, str] = {}
    identity_of = Library.identity

    def identity(kernels: Library, call: Call) -> str:
        made = identity_of(kernels, call)
        found[made] = call[0].split(":")[1]
        return made

    random = np.random.default_rng(1)
    shapes = random_shapes(random, 100)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Library, "identity", identity)
        generic_identity.cache_clear()  # earlier tests may have asked for it
        assert Renderer(1).render(ALL, np.zeros((16, 24, 4), np.uint8))
        assert Renderer(1).reach(ALL, np.zeros((16, 24, 4), np.uint8), 0.5)
        minirt.trace(Scene((AMBIENT, EYE, *shapes)), *random_rays(random, shapes, 10))
    return found


@ELF
@pytest.mark.skipif(LIBRARY.cache is None, reason="kernels cannot be kept here")
def test_kernels_refer_to_nothing_outside_of_themselves() -> None:
    checked = set()
    for identity, name in kernels_of_a_picture().items():
        found = shipped_code.read(identity) or (LIBRARY.cache and LIBRARY.cache.read(identity))
        if found:  # else a more generic or a more specialised kernel was there
            assert (name, is_complete(found)) == (name, True)
            checked.add(name)
    assert checked == {name for name, each in vars(functions).items() if isinstance(each, functions.CompiledFunction)}
    for each in (code_of(double), code_of(quotients, np.zeros(1), np.zeros(1))):
        assert is_complete(each)


@ELF
def test_references_to_a_library_and_to_the_compiler_are_found() -> None:
    """To the compiler's for an error, as for a step of 0 of `range`."""
    assert "sin" in undefined_symbols(code_of(sine)[1])
    assert "numba_unpickle" in undefined_symbols(code_of(step, np.zeros(9), 3)[1])


def test_a_kernel_divides_as_ieee_754_says_and_keeps_nan() -> None:
    x = np.array([1.0, -1.0, 0.0, np.nan, 6.0])
    loader.load(*code_of(quotients, x, np.zeros(5)))(x, y := np.array([0.0, 0.0, 0.0, 1.0, -3.0]))
    assert np.array_equal(y, [np.inf, -np.inf, np.nan, np.nan, -2.0], equal_nan=True)


def test_the_entry_point_is_compiled_with_the_flags_of_the_kernel() -> None:
    """All of them but `nogil`: code for C never holds the lock of the interpreter."""
    assert {"nogil": True, **object_code_module.C_FLAGS} == FLAGS


def test_the_names_say_where_a_kernel_begins_and_how_many_integers_it_returns() -> None:
    for function, arguments, results in ((double, (np.zeros(1),), 0), (both, (np.zeros(1), 2), 2)):
        names, code = code_of(function, *arguments)
        assert names["results"] == results
        if "relocations" in names:
            assert 0 <= names["entry"] < len(code)
            assert all(
                0 <= place <= len(code) - 8 and 0 <= target < len(code) for place, target in names["relocations"]
            )
        else:
            assert names["entry"].encode() in code
