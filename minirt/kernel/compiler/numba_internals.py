"""Private interfaces of numba on which the lean pipeline and the code cache rely, with a check of each.

numba promises none of them from one release to the next, so the package uses them here only, under names of its own.
`minirt.kernel.compiler.options` asks `failed_assumption` at start, and where one fails leaves this module alone.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import llvmlite.binding
from llvmlite import ir
from numba import _dynfunc, njit, types
from numba.core.codegen import JITCodeLibrary, JITCPUCodegen
from numba.core.compiler import CompileResult, Flags
from numba.core.compiler_lock import global_compiler_lock
from numba.core.compiler_machinery import PassManager, _pass_registry
from numba.core.environment import Environment
from numba.core.funcdesc import PythonFunctionDescriptor
from numba.core.registry import CPUDispatcher, cpu_target
from numba.core.typed_passes import NativeLowering, NoPythonBackend, NopythonTypeInference, PreLowerStripPhis
from numba.core.typing import signature
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
    "cache_of",
    "callees_of",
    "failed_assumption",
    "function_object",
    "is_plain",
    "module_to_link",
    "names_and_code",
    "processor_of",
    "rebuilt",
    "run_pass",
    "set_cache",
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


def is_plain(compiled: Any) -> bool:
    """Whether the machine code of a function refers to nothing but itself: no Python objects, loops or addresses."""
    library = compiled.library
    return not (compiled.objectmode or compiled.lifted or library.has_dynamic_globals or compiled.environment.consts)


def names_and_code(compiled: Any) -> tuple[dict[str, Any], bytes]:
    """Return the names by which numba finds a compiled function in its object code, and that code."""
    library, place = compiled.library, compiled.fndesc
    defined = [each.name for each in library.get_defined_functions()]
    names = {"function": place.mangled_name, "environment": place.env_name, "defined": defined}
    return names, library._get_compiled_object()


def rebuilt(
    function: Callable[..., Any],
    target: Any,
    arguments: tuple[Any, ...],
    result: Any,
    names: dict[str, Any],
    code: bytes,
) -> Any:
    """Return the compiled function for arguments of these types, from what `names_and_code` returned.

    Its code lives in an engine of its own, and is freed with it. Only Python can call it, for which numba does not need
    the type of the result: `result` may be None."""
    result = result or types.pyobject
    target = target.subtarget(_internal_codegen=JITCPUCodegen("kernel"))
    written = (function.__qualname__, "object", (code, module_of_names(target.codegen(), names["defined"])))
    place = PythonFunctionDescriptor(
        native=True,
        modname=function.__module__,
        qualname=function.__qualname__,
        unique_name=function.__qualname__,
        doc="",
        typemap=None,
        restype=result,
        calltypes=None,
        args=function.__code__.co_varnames[: function.__code__.co_argcount],
        kws=(),
        mangler=lambda *_, **__: names["function"],
        argtypes=arguments,
        env_name=names["environment"],
    )
    environment, kind = Environment.from_fndesc(place), signature(result, *arguments)
    return CompileResult._rebuild(target, written, place, environment, kind, False, (), "", [], ())


def module_of_names(codegen: Any, names: list[str]) -> Any:
    """Return the LLVM code of empty functions: an engine finds only functions that are declared to it."""
    module = codegen._create_empty_module("names")
    for name in names:
        function = ir.Function(module, ir.FunctionType(ir.VoidType(), ()), name)
        ir.IRBuilder(function.append_basic_block()).ret_void()
    return llvmlite.binding.parse_assembly(str(module)).as_bitcode()


def processor_of(target: Any) -> list[str]:
    """Return what the machine code for a target depends on: platform, processor and its features."""
    return list(target.codegen().magic_tuple())


# The cache of a jitted function.


class CachedDispatcher(CPUDispatcher):
    """A jitted function of which one process at a time compiles a form, while others wait and then load it."""

    def compile(self, signature: Any) -> Any:
        """Load or compile the function for arguments of these types."""
        with global_compiler_lock, self._cache.compiling_once(signature, self.targetctx):
            return super().compile(signature)


def set_cache(dispatcher: Any, cache: Any) -> None:
    """Let a jitted function load and save its machine code by a cache."""
    dispatcher.__class__ = CachedDispatcher
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


DESCRIPTION = {"native", "modname", "qualname", "restype", "args", "mangler", "argtypes", "env_name"}
ASSUMPTIONS: dict[str, Callable[[], bool]] = {
    "the registry of passes": lambda: all(has(_pass_registry.get(each).pass_inst, "run_pass") for each in PASSES),
    "the list of passes of a pass manager": lambda: pass_manager().passes == [(IRProcessing, "description")],
    "function objects": lambda: callable(_dynfunc.make_function),
    "the flag no_compile": lambda: has(Flags(), "no_compile"),
    "functions known to a target": lambda: has(cpu_target.target_context, "insert_user_function"),
    "empty modules": lambda: has(JITCPUCodegen, "_create_empty_module"),
    "the module of a code library": lambda: has(library(), "_final_module", "_finalized", "_linking_libraries"),
    "linking of code libraries": lambda: has(JITCodeLibrary, "_get_module_for_linking", "finalize"),
    "object code": lambda: has(JITCodeLibrary, "_get_compiled_object", "get_defined_functions", "has_dynamic_globals"),
    "engines of a target": lambda: has(cpu_target.target_context, "_internal_codegen", "subtarget"),
    "the name of the processor": lambda: has(JITCPUCodegen, "magic_tuple"),
    "loading of object code": lambda: has(CompileResult, "_rebuild") and has(JITCPUCodegen, "unserialize_library"),
    "environments of functions": lambda: has(Environment, "from_fndesc"),
    "descriptions of functions": lambda: set(inspect.signature(PythonFunctionDescriptor).parameters) >= DESCRIPTION,
    "the cache of a jitted function": lambda: has(njit(error_model="numpy")(lambda: None), "_cache"),
    "the class of a jitted function": lambda: type(njit(error_model="numpy")(lambda: None)) is CPUDispatcher,
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
