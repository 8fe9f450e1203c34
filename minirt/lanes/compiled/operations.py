"""SIMD operations, compiled, on single numbers, lanes and Vecs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types

from minirt.lanes import operations
from minirt.lanes.compiled.inverse_root import inverse_root
from minirt.lanes.compiled.registration import one_number, register, same_numbers, two_numbers
from minirt.lanes.compiled.types import Lanes, Mask, VecType, common, is_number, llvm, vec_of, vec_parts, widen

ANY = types.Any


def register_intrinsic(function: Callable[..., Any], name: str, arguments: int) -> None:
    """Register an operation that is one LLVM intrinsic."""

    @register(function, one_number if arguments == 1 else two_numbers, [(ANY,) * arguments])
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        return llvm(builder, name, *same_numbers(context, builder, sig, args))


def register_selection(function: Callable[..., Any], symbol: str) -> None:
    """Register an operation that selects a number if it compares so with another, and that other if not."""

    @register(function, two_numbers, [(ANY, ANY)])
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        a, b = same_numbers(context, builder, sig, args)
        return builder.select(builder.fcmp_ordered(symbol, a, b), a, b)


register_intrinsic(operations.sqrt, "sqrt", 1)
register_intrinsic(operations.fabs, "fabs", 1)
register_intrinsic(operations.floor, "floor", 1)
register_intrinsic(operations.copysign, "copysign", 2)
register_selection(operations.minimum, "<")
register_selection(operations.maximum, ">")


@register(operations.inverse_root, one_number, [(ANY,)])
def _inverse_root(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return inverse_root(context, builder, *same_numbers(context, builder, sig, args))


def where_type(mask: types.Type, a: types.Type, b: types.Type) -> types.Type | None:
    """Return the type of `where`: lanes if one of its arguments has lanes."""
    if isinstance(a, VecType) and isinstance(b, VecType):
        return VecType(where_type(mask, a.number, b.number))
    if is_number(a) and is_number(b):
        return mask.lanes if isinstance(mask, Mask) else common(a, b)
    return None


@register(operations.where, where_type, [(ANY, ANY, ANY)])
def _where(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    mask, a, b = args
    if isinstance(sig.return_type, VecType):
        number = sig.return_type.number
        parts = [
            builder.select(
                mask,
                *(
                    widen(context, builder, part, kind.number, number)
                    for part, kind in zip(pair, sig.args[1:], strict=True)
                ),
            )
            for pair in zip(vec_parts(builder, a), vec_parts(builder, b), strict=True)
        ]
        return vec_of(context, builder, sig.return_type, parts)
    return builder.select(
        mask,
        *(
            widen(context, builder, value, kind, sig.return_type)
            for value, kind in zip((a, b), sig.args[1:], strict=True)
        ),
    )


@register(operations.width, lambda x: types.int64 if isinstance(x, (Lanes, types.Array)) else None, [(ANY,)])
def _width(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    kind = sig.args[0]
    return context.get_constant(types.int64, (Lanes(kind.dtype) if isinstance(kind, types.Array) else kind).count)


@register(
    operations.lane,
    lambda x, ray: x.number if isinstance(x, Lanes) and isinstance(ray, types.Integer) else None,
    [(Lanes, types.Integer)],
)
def _lane(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.extract_element(args[0], context.cast(builder, args[1], sig.args[1], types.int32))


def second_type(x: types.Type, like: types.Type) -> types.Type | None:
    """Return the type of the second argument: lanes, or a single number."""
    return like if is_number(x) and isinstance(like, (Lanes, types.Float)) else None


@register(operations.splat, second_type, [(ANY, ANY)])
def _splat(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return widen(context, builder, args[0], sig.args[0], sig.return_type)
