"""Compiles a function to object code with one entry point, which C can call: it takes the address of its arguments.

See `minirt.kernel.machine_code.arguments`. The code refers to nothing outside of itself but C's `memset`, neither to
Python nor to the compiler. Outside this folder the functions that kernels call are plain Python, and call each other as
they stand: importing this module registers all of them, and numba finds the compiled form of each.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from operator import attrgetter
from pkgutil import iter_modules
from types import FunctionType
from typing import Any

from llvmlite import ir
from numba import cfunc, from_dtype, types
from numba.core import cgutils
from numba.core.typing import signature
from numba.extending import intrinsic, overload

from minirt import kernel, lanes, shapes
from minirt.kernel import scene_arrays, shading
from minirt.kernel.compiler import operations  # noqa: F401  (registers what it compiles)
from minirt.kernel.compiler.by_reference import item_of, item_type
from minirt.kernel.compiler.pipeline import FLAGS, INLINED, inline_functions_of
from minirt.kernel.machine_code.arguments import Signature, dtype_of, named
from minirt.kernel.machine_code.cache import ObjectCode
from minirt.lanes.compiled.memory import ADDRESS, Reference
from minirt.lanes.compiled.types import REGISTERED

SCALARS = {"int": types.int64, "float": types.float64}


def by_kind(function: Any, choose: Callable[[Any], Any]) -> None:
    """Compile calls of a function as those of the one that is chosen for the kind of the first argument.

    The type of a packed shape tells its kind: so a kernel has code for the kinds of its scene alone.
    """

    def chosen(shape: Any, *_: Any) -> Any:
        return choose(scene_arrays.kind_of_packed(shape.instance_class))

    REGISTERED.add(function)
    overload(function, jit_options=INLINED, strict=False)(chosen)


for _name in ("surface", "shading", "smooth_point", "may_meet", "mapping"):
    by_kind(getattr(scene_arrays, _name), attrgetter(_name))
by_kind(scene_arrays.is_convex, lambda kind: (lambda shape: True) if kind.element.convex else (lambda shape: False))
by_kind(scene_arrays.formula, lambda kind: kind.intersect)

for _package in (lanes, shapes, kernel, shading):
    inline_functions_of(_package)
    for _module in iter_modules(_package.__path__, f"{_package.__name__}."):
        if not _module.ispkg:
            inline_functions_of(import_module(_module.name))


def type_of(signature: Signature) -> Any:
    """Return numba's type of an argument with a signature."""
    if signature is None:
        return types.none
    if isinstance(signature, str):
        return SCALARS[signature]
    if "array" in signature:
        return types.Array(from_dtype(dtype_of(signature)), signature["ndim"], "C")
    kind = named(signature["tuple"])
    items = [type_of(each) for each in signature["items"]]
    return types.BaseTuple.from_types(items, None if kind is tuple else kind)


def object_code(function: str, signatures: list[Signature]) -> ObjectCode:
    """Return the object code of a function, "module:name", for arguments of these signatures."""
    compiled = compiled_entry(named(function), signatures)
    return ObjectCode(compiled.native_name, compiled._library._get_compiled_object())


def compiled_entry(called: FunctionType, signatures: list[Signature]) -> Any:
    """Compile a function, which returns nothing, for arguments of these signatures; return numba's C function for it.

    The C function takes the address of the words of all arguments, and calls `called` with tuples and arrays by
    reference, see `minirt.kernel.compiler.by_reference`.
    """
    inline_functions_of(import_module(called.__module__))
    kinds = types.Tuple([type_of(each) for each in signatures])

    @intrinsic  # type: ignore[untyped-decorator]
    def arguments_at(_typing: Any, address: Any) -> Any:  # the tuple of all arguments
        whole = Reference(kinds)

        def load(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
            # A copy on the stack, which nothing else can change, is read once, as if its parts were local variables.
            words = builder.load(builder.bitcast(args[0], context.get_value_type(kinds).as_pointer()))
            copy = builder.bitcast(cgutils.alloca_once_value(builder, words), ADDRESS)
            parts = [item_of(context, builder, whole, copy, position) for position in range(len(kinds))]
            return context.make_tuple(builder, sig.return_type, parts)

        return signature(types.Tuple([item_type(whole, position) for position in range(len(kinds))]), address), load

    def entry(address: Any) -> None:
        called(*arguments_at(address))

    return cfunc(types.void(types.voidptr), **FLAGS)(entry)
