"""Compiles a function to object code with one entry point, which C can call: it takes the address of an argument block.

See `minirt.kernel.machine_code.argument_block`. The code refers to nothing outside of itself, neither to Python nor to
the compiler.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import cache
from importlib import import_module
from typing import Any

from llvmlite import ir
from numba import cfunc, types
from numba.core.typing import signature
from numba.extending import intrinsic, register_jitable

from minirt.kernel.compiler import bvh_functions, kernel_functions  # noqa: F401  (register what kernels call)
from minirt.kernel.compiler.argument_types import type_of
from minirt.kernel.compiler.elf_image import image_of
from minirt.kernel.compiler.options import FAILED, FLAGS, INLINED
from minirt.kernel.machine_code.processor import is_linux_on_x86_64
from minirt.kernel.machine_code.signature import Signature

C_FLAGS = {name: value for name, value in FLAGS.items() if name != "nogil"}  # code for C never holds Python's lock


def object_code(function: str, signatures: list[Signature]) -> tuple[dict[str, Any], bytes]:
    """Return names and object code of a function, "module:name", for arguments of these signatures."""
    module, name = function.split(":")
    plain = getattr(import_module(module), name)
    register(plain)
    entry = EntryPoint(plain, types.Tuple([type_of(each) for each in signatures]))
    compiled = cfunc(types.void(types.voidptr), **C_FLAGS)(entry.function())
    names, code = loadable(compiled.native_name, machine_code(compiled))
    return names | {"results": entry.results}, code


def loadable(entry: str, code: bytes) -> tuple[dict[str, Any], bytes]:
    """Return an image of object code where that can be loaded, else the object code itself, with its entry point."""
    if is_linux_on_x86_64():
        with suppress(ValueError):
            return image_of(code, entry)
    return {"entry": entry}, code


@cache
def register(function: Callable[..., Any]) -> None:
    """Let compiled code inline a function."""
    register_jitable(**INLINED)(function)


class EntryPoint:
    """An entry point of a function: it takes the address of its arguments, and stores the result behind them."""

    def __init__(self, called: Callable[..., Any], kinds: Any) -> None:
        """`kinds` is the type of the tuple of all arguments."""
        self.called = called
        self.kinds = kinds
        self.results = 0  # integers that the function returns, known when the entry point has been compiled

    def function(self) -> Callable[[Any], None]:
        """Return the entry point, to be compiled."""
        called, arguments_at, store_result = self.called, intrinsic(self.arguments_at), intrinsic(self.store_result)

        def entry(address: Any) -> None:
            store_result(address, called(*arguments_at(address)))

        return entry

    def arguments_at(self, _typing: Any, address: Any) -> Any:
        """Load the arguments: typing and code of an operation."""

        def load(context: Any, builder: ir.IRBuilder, _signature: Any, args: Any) -> Any:
            return builder.load(builder.bitcast(args[0], context.get_value_type(self.kinds).as_pointer()))

        return signature(self.kinds, address), load

    def store_result(self, _typing: Any, address: Any, result: Any) -> Any:
        """Store the result: typing and code of an operation."""
        results = list(result) if isinstance(result, types.BaseTuple) else [result] * (result != types.none)
        if any(types.unliteral(each) != types.int64 for each in results):
            raise TypeError(f"a kernel returns integers of 64 bits or nothing, not {result}")
        self.results = len(results)

        def store(context: Any, builder: ir.IRBuilder, _signature: Any, args: Any) -> Any:
            if self.results:
                end = context.get_abi_sizeof(context.get_value_type(self.kinds))
                place = builder.gep(args[0], [ir.Constant(ir.IntType(64), end)])
                builder.store(args[1], builder.bitcast(place, args[1].type.as_pointer()))
            return context.get_dummy_value()

        return signature(types.none, address, result), store


def machine_code(entry: Any) -> bytes:
    """Return the object code of a C function that numba has compiled."""
    if FAILED:
        return import_module("minirt.kernel.compiler.documented_pipeline").machine_code(entry)
    return import_module("minirt.kernel.compiler.numba_internals").machine_code(entry)
