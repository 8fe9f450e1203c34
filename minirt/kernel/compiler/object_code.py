"""Compiles a function to object code with one entry point, which C can call: it takes the address of an argument block.

See `minirt.kernel.machine_code.argument_block`. The code refers to nothing outside of itself, neither to Python nor to
the compiler.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any

from llvmlite import ir
from numba import cfunc, njit, types
from numba.core.typing import signature
from numba.extending import intrinsic

from minirt.kernel.compiler import bvh_functions, kernel_functions  # noqa: F401  (register what kernels call)
from minirt.kernel.compiler.argument_types import type_of
from minirt.kernel.compiler.options import FAILED, FLAGS
from minirt.kernel.machine_code.signature import Signature

WORD = 8  # bytes
ENTRY_FLAGS = {name: value for name, value in FLAGS.items() if name != "nogil"}  # code for C never holds Python's lock
WITHOUT_WRAPPERS = {"forceinline": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def object_code(function: str, signatures: list[Signature]) -> tuple[dict[str, Any], bytes]:
    """Return names and object code of a function, "module:name", for arguments of these signatures."""
    module, name = function.split(":")
    plain = getattr(import_module(module), name)
    kinds = types.Tuple([type_of(each) for each in signatures])
    compiled = njit(**WITHOUT_WRAPPERS, **FLAGS)(plain)
    results = result_count(compiled, kinds)
    entry = cfunc(types.void(types.voidptr), **ENTRY_FLAGS)(entry_point(compiled, kinds, results))
    return {"entry": entry.native_name, "results": results}, machine_code(entry)


def result_count(compiled: Any, kinds: Any) -> int:
    """Return the number of integers that a function returns; TypeError where it returns anything else."""
    result = compiled.get_call_template(tuple(kinds), {})[0].cases[0].return_type
    results = list(result) if isinstance(result, types.BaseTuple) else [result] * (result != types.none)
    if any(types.unliteral(each) != types.int64 for each in results):
        raise TypeError(f"a kernel returns integers of 64 bits or nothing, not {result}")
    return len(results)


def entry_point(compiled: Callable[..., Any], kinds: Any, results: int) -> Callable[[Any], None]:
    """Return a function that takes the address of an argument block, calls a function and stores its result there."""

    @intrinsic  # type: ignore[untyped-decorator]
    def arguments_at(_typing: Any, address: Any) -> Any:
        def load(context: Any, builder: ir.IRBuilder, _signature: Any, args: Any) -> Any:
            place = builder.gep(args[0], [ir.Constant(ir.IntType(64), WORD * results)])
            return builder.load(builder.bitcast(place, context.get_value_type(kinds).as_pointer()))

        return signature(kinds, address), load

    @intrinsic  # type: ignore[untyped-decorator]
    def store_result(_typing: Any, address: Any, result: Any) -> Any:
        def store(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
            if results:
                builder.store(args[1], builder.bitcast(args[0], args[1].type.as_pointer()))
            return context.get_dummy_value()

        return signature(types.none, address, result), store

    def entry(address: Any) -> None:
        store_result(address, compiled(*arguments_at(address)))

    return entry


def machine_code(entry: Any) -> bytes:
    """Return the object code of a C function that numba has compiled."""
    if FAILED:
        return import_module("minirt.kernel.compiler.documented_pipeline").machine_code(entry)
    return import_module("minirt.kernel.compiler.numba_internals").machine_code(entry)
