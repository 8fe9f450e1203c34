"""Private interfaces of numba on which the lean pipeline and the code cache rely, with a check of each.

numba promises none of them from one release to the next, so the package uses them here only, under names of its own.
`minirt.kernel.compiler.options` asks `failed_assumption` at start, and where one fails leaves this module alone.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import llvmlite.binding
from llvmlite import ir
from numba import _dynfunc, njit
from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile
from numba.core.codegen import JITCodeLibrary, JITCPUCodegen
from numba.core.compiler import Flags
from numba.core.compiler_machinery import PassManager, _pass_registry
from numba.core.registry import cpu_target
from numba.core.typed_passes import NativeLowering, NoPythonBackend, NopythonTypeInference, PreLowerStripPhis
from numba.core.untyped_passes import DeadBranchPrune, FixupArgs, IRProcessing, ReconstructSSA, TranslateByteCode

__all__ = [
    "CodeLibrary",
    "DeadBranchPrune",
    "DiskCache",
    "FixupArgs",
    "IRProcessing",
    "NativeLowering",
    "NoPythonBackend",
    "NopythonTypeInference",
    "PreLowerStripPhis",
    "ReconstructSSA",
    "Serializer",
    "TranslateByteCode",
    "cache_of",
    "callees_of",
    "failed_assumption",
    "function_object",
    "keep_names_only",
    "module_to_link",
    "run_pass",
    "set_cache",
    "with_own_engine",
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


def keep_names_only(library: Any) -> None:
    """Replace the LLVM code that numba would write beside the machine code of a library by empty functions.

    An engine finds only functions that are declared to it, so the names have to stay.
    """
    names = library.codegen._create_empty_module(library.name)
    for each in library.get_defined_functions():
        function = ir.Function(names, ir.FunctionType(ir.VoidType(), ()), each.name)
        ir.IRBuilder(function.append_basic_block()).ret_void()
    library._shared_module = llvmlite.binding.parse_assembly(str(names))


def with_own_engine(target: Any) -> Any:
    """Return a target context whose code lives in an engine of its own, and is freed with it."""
    return target.subtarget(_internal_codegen=JITCPUCodegen("kernel"))


# The cache on disk.


class Serializer(CompileResultCacheImpl):
    """Turns a compiled function into bytes and back, by `reduce` and `rebuild`."""


class DiskCache(FunctionCache):
    """Compiled forms of one function on disk."""

    serializer: type[Serializer] = Serializer

    @property
    def _impl_class(self) -> type[Serializer]:
        return self.serializer

    def load_overload(self, signature: Any, target: Any) -> Any:
        """Return the function for arguments of these types, or None, without numba's preparations for compiling."""
        with self._guard_against_spurious_io_errors():
            return self._load_overload(signature, target)

    def contains(self, signature: Any, target: Any) -> bool:
        """Whether the function for arguments of these types is on disk."""
        return self._index_key(signature, target.codegen()) in self._cache_file._load_index()


def set_cache(dispatcher: Any, cache: DiskCache) -> None:
    """Let a jitted function load and save its machine code by a cache."""
    dispatcher._cache = cache


def cache_of(dispatcher: Any) -> Any:
    """Return the cache of a jitted function."""
    return dispatcher._cache


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
    "empty modules": lambda: has(JITCPUCodegen, "_create_empty_module"),
    "the module of a code library": lambda: has(library(), "_final_module", "_finalized", "_linking_libraries"),
    "linking of code libraries": lambda: has(JITCodeLibrary, "_get_module_for_linking", "finalize"),
    "the module that is written with machine code": lambda: has(library(), "_shared_module", "get_defined_functions"),
    "engines of a target": lambda: has(cpu_target.target_context, "_internal_codegen", "subtarget"),
    "the implementation of a cache": lambda: has(FunctionCache, "_impl_class", "load_overload", "save_overload"),
    "serialization of compiled functions": lambda: has(CompileResultCacheImpl, "reduce", "rebuild"),
    "loading from a cache": lambda: has(
        FunctionCache, "_load_overload", "_guard_against_spurious_io_errors", "cache_path"
    ),
    "the index of a cache": lambda: has(FunctionCache, "_index_key") and has(IndexDataCacheFile, "_load_index"),
    "the cache of a jitted function": lambda: has(njit(error_model="numpy")(lambda: None), "_cache"),
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
