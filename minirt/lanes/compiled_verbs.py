"""The verbs of the formulas, compiled, on float64, lanes and Vecs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types

from minirt.lanes import verbs
from minirt.lanes.teaching import one_number, same_numbers, teach, two_numbers
from minirt.lanes.vector import (
    BITS,
    LANES,
    LANES_IR,
    MASK,
    Lanes,
    Mask,
    VecType,
    common,
    is_number,
    llvm,
    splat,
    vec_of,
    vec_parts,
    widen,
)

ANY = types.Any


def teach_llvm(function: Callable[..., Any], name: str, arguments: int) -> None:
    @teach(function, one_number if arguments == 1 else two_numbers, [(ANY,) * arguments])
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        return llvm(builder, name, *same_numbers(context, builder, sig, args))


def teach_choice(function: Callable[..., Any], symbol: str) -> None:
    @teach(function, two_numbers, [(ANY, ANY)])
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        a, b = same_numbers(context, builder, sig, args)
        return builder.select(builder.fcmp_ordered(symbol, a, b), a, b)


teach_llvm(verbs.sqrt, "sqrt", 1)
teach_llvm(verbs.fabs, "fabs", 1)
teach_llvm(verbs.floor, "floor", 1)
teach_llvm(verbs.copysign, "copysign", 2)


@teach(verbs.rounded_product, two_numbers, [(ANY, ANY)])
def _rounded_product(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.fmul(*same_numbers(context, builder, sig, args))


@teach(verbs.product_error, two_numbers, [(ANY, ANY)])
def _product_error(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    a, b = same_numbers(context, builder, sig, args)
    return llvm(builder, "fma", a, b, builder.fneg(builder.fmul(a, b)))


teach_choice(verbs.minimum, "<")
teach_choice(verbs.maximum, ">")


def chosen(mask: types.Type, a: types.Type, b: types.Type) -> types.Type | None:
    """The type of `where`: lanes as soon as one of its arguments has lanes."""
    if isinstance(a, VecType) and isinstance(b, VecType):
        return VecType(chosen(mask, a.number, b.number))
    if mask in (MASK, types.boolean) and is_number(a) and is_number(b):
        return LANES if mask == MASK else common(a, b)
    return None


@teach(verbs.where, chosen, [(ANY, ANY, ANY)])
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


def bits(builder: ir.IRBuilder, mask: Any) -> Any:
    """A mask as a whole number with one bit a lane."""
    return builder.bitcast(mask, BITS)


@teach(verbs.any, lambda mask: types.boolean if mask in (MASK, types.boolean) else None, [(ANY,)])
def _any(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.icmp_unsigned("!=", bits(builder, args[0]), ir.Constant(BITS, 0)) if sig.args[0] == MASK else args[0]


@teach(verbs.first, lambda mask: types.int64 if mask == MASK else None, [(Mask,)])
def _first(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.cttz(builder.zext(bits(builder, args[0]), ir.IntType(64)), ir.Constant(ir.IntType(1), 1))


@teach(
    verbs.lane,
    lambda x, ray: types.float64 if x == LANES and isinstance(ray, types.Integer) else None,
    [(Lanes, types.Integer)],
)
def _lane(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.extract_element(args[0], context.cast(builder, args[1], sig.args[1], types.int32))


@teach(verbs.splat, lambda x: LANES if is_number(x) and x != LANES else None, [(ANY,)])
def _splat(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return splat(builder, context.cast(builder, args[0], sig.args[0], types.float64))


@teach(
    verbs.load, lambda values, start: LANES if isinstance(values, types.Array) else None, [(types.Array, types.Integer)]
)
def _load(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    values = context.make_array(sig.args[0])(context, builder, value=args[0])
    place = builder.gep(values.data, [context.cast(builder, args[1], sig.args[1], types.intp)])
    return builder.load(builder.bitcast(place, LANES_IR.as_pointer()), align=8)
