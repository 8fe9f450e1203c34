"""numba's private interfaces: as expected in the installed version, and a change of any is noticed."""

from __future__ import annotations

from typing import Any

import numba
import pytest
from numba import njit
from numba.core.compiler import Flags
from numba.extending import register_jitable

from minirt.kernel.compiler import numba_internals, options
from minirt.kernel.compiler.numba_internals import ASSUMPTIONS, failed_assumption

# For each interface an owner that loses an attribute.
CHANGES: list[tuple[str, Any, str]] = [
    ("the registry of passes", type(numba_internals._pass_registry), "get"),
    ("the list of passes of a pass manager", numba_internals.PassManager, "add_pass"),
    ("function objects", numba_internals, "_dynfunc"),
    ("the flag no_compile", Flags, "no_compile"),
    ("functions known to a target", numba.core.base.BaseContext, "insert_user_function"),
    ("the module of a code library", numba_internals.JITCodeLibrary, "_finalized"),
    ("linking of code libraries", numba_internals.JITCodeLibrary, "_get_module_for_linking"),
    ("object code", numba_internals.JITCodeLibrary, "_get_compiled_object"),
    ("object code", numba_internals.CFunc, "inspect_llvm"),
]


@pytest.mark.parametrize("interface", ASSUMPTIONS)
def test_the_installed_numba_is_as_expected(interface: str) -> None:
    assert ASSUMPTIONS[interface]()


def test_every_assumption_has_a_change_that_breaks_it() -> None:
    assert {interface for interface, _, _ in CHANGES} == set(ASSUMPTIONS)


@pytest.mark.parametrize(("interface", "owner", "name"), CHANGES)
def test_a_changed_interface_is_noticed(interface: str, owner: Any, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    assert failed_assumption() is None
    if owner is numba_internals:
        monkeypatch.setattr(owner, name, lambda **options: lambda function: function)
    for each in getattr(owner, "__mro__", ()):
        if name in vars(each):
            monkeypatch.delattr(each, name)
    assert (failed_assumption() or "").startswith(interface)


@register_jitable(**options.INLINED)
def power_of(x: float, n: int) -> float:
    result = 1.0
    for _ in range(n):
        result = result * x
    return result


@register_jitable(**options.INLINED)
def alternating(x: float, n: int) -> float:
    return -power_of(x, n) if n % 2 else power_of(x, n)


def entry(x: float, n: int) -> float:
    return alternating(x, n) + alternating(x, 2)


def test_inlined_functions_loop_branch_and_call_each_other() -> None:
    compiled = njit(**options.FLAGS)(entry)
    for n in range(4):
        assert compiled(1.5, n) == entry(1.5, n)


def test_inlined_functions_have_no_machine_code_of_their_own() -> None:
    compiled = njit(**options.FLAGS)(entry)
    compiled(1.5, 3)
    (code,) = compiled.inspect_asm().values()
    functions = [line for line in code.splitlines() if line.endswith("@function")]
    assert any("entry" in line for line in functions)
    assert not any("alternating" in line or "power_of" in line for line in functions)


def test_tested_versions_have_the_private_interfaces() -> None:
    name, limit = options.TESTED.split("<")
    assert name == "numba"
    is_tested = tuple(map(int, numba.__version__.split(".")[:2])) < tuple(map(int, limit.split(".")))
    assert not is_tested or options.FAILED is None
