"""How machine code is kept, on disk and in memory.

numba keeps it beside LLVM's code, for functions that would call it, finds it only when all that a compiler needs is
loaded, and holds it in memory until the program ends. What is compiled here nothing calls but Python, and an editor
meets ever new combinations of shapes: so machine code alone is kept, loaded without a compiler, and each function has
an engine of its own, whose memory is free again when nobody holds the function any more.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from llvmlite import ir
from llvmlite.binding import parse_assembly
from numba import njit
from numba.core.caching import CompileResultCacheImpl, FunctionCache
from numba.core.codegen import JITCPUCodegen

from minirt.kernel.compiler.cache_folder import locked, numba_cache

# error_model: x / 0 is infinite or NaN, as in IEEE 754. fastmath: a * b + c may round once, and nothing else. _nrt: the
# kernel allocates nothing, and without reference counting it was seen to run twice as fast.
FLAGS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}, "nogil": True, "_nrt": False}


class MachineCode(CompileResultCacheImpl):
    """What goes to disk and comes back."""

    def reduce(self, compiled: Any) -> Any:
        """What is written: of LLVM's code the names alone, since an engine finds only functions that it knows of."""
        library = compiled.library
        names = library.codegen._create_empty_module(library.name)
        for each in library.get_defined_functions():
            function = ir.Function(names, ir.FunctionType(ir.VoidType(), ()), each.name)
            ir.IRBuilder(function.append_basic_block()).ret_void()
        library._shared_module = parse_assembly(str(names))
        return super().reduce(compiled)

    def rebuild(self, target: Any, written: Any) -> Any:
        """A function that can be called."""
        return super().rebuild(target.subtarget(_internal_codegen=JITCPUCodegen("kernel")), written)


class CodeCache(FunctionCache):
    """Writes and finds the machine code of a function."""

    _impl_class = MachineCode

    def load_overload(self, signature: Any, target: Any) -> Any:
        """The function for arguments of these types, or None; numba would make the target ready for compiling first."""
        with self._guard_against_spurious_io_errors():
            return self._load_overload(signature, target)

    def save_overload(self, signature: Any, made: Any) -> None:
        """Write the machine code, one process at a time."""
        with locked(Path(self.cache_path)):
            super().save_overload(signature, made)


def compiled(function: Callable[..., Any], place: Path | None, *signatures: Any) -> Any:
    """A function with its compiled form, which is kept in `place`, where there is one.

    It is compiled or loaded at once where the types of its arguments are said, when it is first called otherwise."""
    made = njit(no_cfunc_wrapper=True, **FLAGS)(function)
    if place:
        with numba_cache(place):
            made._cache = CodeCache(function)
    for signature in signatures:
        made.compile(signature)
    return made
