"""How the machine code of a kernel is kept, on disk and in memory.

numba keeps it beside LLVM's code, for functions that would call it, and in memory until the program ends. Nothing calls
a kernel but Python, and an editor meets ever new combinations of shapes: so only machine code is kept, and each kernel
has an engine of its own, whose memory is free again when nobody holds the kernel any more.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from llvmlite.binding import parse_assembly
from numba.core.caching import CompileResultCacheImpl, FunctionCache
from numba.core.codegen import JITCPUCodegen


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


class Keeper(FunctionCache):
    """Writes and finds the machine code of a kernel."""

    _impl_class = MachineCode
