"""Private interfaces of numba on which the lean pipeline and object code rely, with a check of each.

numba promises none of them from one release to the next, so the package uses them here only, under names of its own.
`minirt.kernel.compiler.options` asks `failed_assumption` at start, and where one fails leaves this module alone.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import _dynfunc
from numba.core.ccallback import CFunc
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Flags
from numba.core.compiler_machinery import PassManager, _pass_registry
from numba.core.registry import cpu_target
from numba.core.typed_passes import NativeLowering, NoPythonBackend, NopythonTypeInference, PreLowerStripPhis
from numba.core.untyped_passes import DeadBranchPrune, FixupArgs, IRProcessing, ReconstructSSA, TranslateByteCode

__all__ = [
    "CodeLibrary",
    "DeadBranchPrune",
    "FixupArgs",
    "IRProcessing",
    "NativeLowering",
    "NoPythonBackend",
    "NopythonTypeInference",
    "PreLowerStripPhis",
    "ReconstructSSA",
    "TranslateByteCode",
    "callees_of",
    "failed_assumption",
    "function_object",
    "machine_code",
    "module_to_link",
    "run_pass",
]

PASSES = (
    TranslateByteCode,
    FixupArgs,
    IRProcessing,
    DeadBranchPrune,
    ReconstructSSA,
    NopythonTypeInference,
    PreLowerStripPhis,
    NativeLowering,
    NoPythonBackend,
)

# Compiler passes.


def run_pass(step: type, state: Any) -> None:
    """Run a registered compiler pass without the bookkeeping of numba's own pass manager."""
    _pass_registry.get(step).pass_inst.run_pass(state)


def function_object(lowered: Any, library: Any) -> Any:
    """Return the object by which numba finds a compiled function; calls of it from Python are not possible."""
    place = lowered.fndesc
    return _dynfunc.make_function(place.lookup_module(), place.qualname, "", 0, lowered.env, library)


# Libraries of LLVM code.


class CodeLibrary(JITCodeLibrary):
    """A library of LLVM code that decides itself how it is finished and what others link."""

    @property
    def module(self) -> Any:
        """The LLVM module."""
        return self._final_module

    def mark_finalized(self) -> None:
        """Refuse further code."""
        self._finalized = True

    def linked_module(self) -> Any:
        """Return the module that other libraries link."""
        raise NotImplementedError

    def _get_module_for_linking(self) -> Any:
        return self.linked_module()


def callees_of(library: Any) -> list[Any]:
    """Return the libraries that a library calls directly."""
    libraries: list[Any] = library._linking_libraries
    return libraries


def module_to_link(library: Any) -> Any:
    """Return the module of a library that other libraries link."""
    return library._get_module_for_linking()


# Machine code of kernels as plain data.


def machine_code(entry: Any) -> bytes:
    """Return the object code of a C function that `numba.cfunc` has compiled."""
    code: bytes = entry._library._get_compiled_object()
    return code


# Checks: they look at names and at small objects and compile nothing, which takes a few milliseconds.


def has(thing: Any, *names: str) -> bool:
    """Whether a class or an object has attributes of all these names."""
    return all(hasattr(thing, name) for name in names)


def library() -> Any:
    """Return an empty library of LLVM code."""
    return cpu_target.target_context.codegen().create_library("check")


def pass_manager() -> PassManager:
    """Return a pass manager with one pass."""
    manager = PassManager("check")
    manager.add_pass(IRProcessing, "description")
    return manager


ASSUMPTIONS: dict[str, Callable[[], bool]] = {
    "the registry of passes": lambda: all(has(_pass_registry.get(each).pass_inst, "run_pass") for each in PASSES),
    "the list of passes of a pass manager": lambda: pass_manager().passes == [(IRProcessing, "description")],
    "function objects": lambda: callable(_dynfunc.make_function),
    "the flag no_compile": lambda: has(Flags(), "no_compile"),
    "functions known to a target": lambda: has(cpu_target.target_context, "insert_user_function"),
    "the module of a code library": lambda: has(library(), "_final_module", "_finalized", "_linking_libraries"),
    "linking of code libraries": lambda: has(JITCodeLibrary, "_get_module_for_linking", "finalize"),
    "object code": lambda: (
        has(JITCodeLibrary, "_get_compiled_object") and "_library" in CFunc.inspect_llvm.__code__.co_names
    ),
}


def failed_assumption() -> str | None:
    """Return the name of the first interface that is not as expected in the installed numba; None where all are."""
    for interface, is_as_expected in ASSUMPTIONS.items():
        try:
            if not is_as_expected():
                return interface
        except (AttributeError, ImportError, KeyError, TypeError) as error:
            return f"{interface}: {error}"
    return None
