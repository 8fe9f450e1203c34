"""The verbs of the formulas, compiled, on float64, lanes and Vecs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types

from minirt.lanes import operations
from minirt.lanes.compiled.inverse_root import inverse_root
from minirt.lanes.compiled.registration import one_number, register, same_numbers, two_numbers
from minirt.lanes.compiled.types import (
    Lanes,
    Mask,
    VecType,
    common,
    constant,
    is_number,
    llvm,
    vec_of,
    vec_parts,
    widen,
)

ANY = types.Any
ROUNDOFF = {64: 2.0**-53, 32: 2.0**-24}  # by the size of a number in bits


def teach_llvm(function: Callable[..., Any], name: str, arguments: int) -> None:
    @register(function, one_number if arguments == 1 else two_numbers, [(ANY,) * arguments])
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        return llvm(builder, name, *same_numbers(context, builder, sig, args))


def teach_choice(function: Callable[..., Any], symbol: str) -> None:
    @register(function, two_numbers, [(ANY, ANY)])
    def generate(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
        a, b = same_numbers(context, builder, sig, args)
        return builder.select(builder.fcmp_ordered(symbol, a, b), a, b)


teach_llvm(operations.sqrt, "sqrt", 1)
teach_llvm(operations.fabs, "fabs", 1)
teach_llvm(operations.floor, "floor", 1)
teach_llvm(operations.copysign, "copysign", 2)


@register(operations.inverse_root, one_number, [(ANY,)])
def _inverse_root(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return inverse_root(context, builder, *same_numbers(context, builder, sig, args))


# How many bits of a number are its fraction, and what its exponent is stored with added, by the size of a number.
FRACTION = {64: 52, 32: 23}
BIAS = {64: 1023, 32: 127}


def words_of(number: types.Float, like: Any) -> tuple[ir.Type, int, int]:
    """The whole numbers that lie in the place of numbers, their bits of fraction and their bias."""
    word = ir.IntType(number.bitwidth)
    lanes = isinstance(like.type, ir.VectorType)
    return ir.VectorType(word, like.type.count) if lanes else word, FRACTION[number.bitwidth], BIAS[number.bitwidth]


@register(operations.exponent, one_number, [(ANY,)])
def _exponent(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    (x,) = same_numbers(context, builder, sig, args)
    words, fraction, bias = words_of(single(sig.return_type), x)
    stored = builder.bitcast(x, words)
    stored = builder.lshr(stored, constant(stored, fraction))
    return builder.sitofp(builder.sub(stored, constant(stored, bias)), x.type)


@register(operations.two_to, one_number, [(ANY,)])
def _two_to(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    (x,) = same_numbers(context, builder, sig, args)
    words, fraction, bias = words_of(single(sig.return_type), x)
    kept = llvm(builder, "maxnum", x, constant(x, float(-bias)))
    whole = builder.fptosi(kept, words)
    stored = builder.shl(builder.add(whole, constant(whole, bias)), constant(whole, fraction))
    return builder.bitcast(stored, x.type)


@register(operations.rounded_product, two_numbers, [(ANY, ANY)])
def _rounded_product(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    # Without the fence the flags of the kernel allow to fuse it with a sum that follows.
    return llvm(builder, "arithmetic.fence", builder.fmul(*same_numbers(context, builder, sig, args)))


@register(operations.product_error, two_numbers, [(ANY, ANY)])
def _product_error(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    a, b = same_numbers(context, builder, sig, args)
    return llvm(builder, "fma", a, b, builder.fneg(builder.fmul(a, b)))


teach_choice(operations.minimum, "<")
teach_choice(operations.maximum, ">")


def chosen(mask: types.Type, a: types.Type, b: types.Type) -> types.Type | None:
    """The type of `where`: lanes as soon as one of its arguments has lanes."""
    if isinstance(a, VecType) and isinstance(b, VecType):
        return VecType(chosen(mask, a.number, b.number))
    if is_number(a) and is_number(b):
        return mask.lanes if isinstance(mask, Mask) else common(a, b)
    return None


@register(operations.where, chosen, [(ANY, ANY, ANY)])
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


def like_the_second(x: types.Type, like: types.Type) -> types.Type | None:
    """What the second is: lanes, or a single number."""
    return like if is_number(x) and isinstance(like, (Lanes, types.Float)) else None


@register(operations.splat, like_the_second, [(ANY, ANY)])
def _splat(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return widen(context, builder, args[0], sig.args[0], sig.return_type)


def single(x: types.Type) -> types.Type | None:
    """The type of one number of x."""
    return getattr(common(x), "number", common(x)) if is_number(x) else None


@register(operations.unit_roundoff, single, [(ANY,)])
def _unit_roundoff(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return context.get_constant(sig.return_type, ROUNDOFF[sig.return_type.bitwidth])


def loaded(values: types.Type, start: types.Type) -> types.Type | None:
    """Lanes of what an array holds."""
    return Lanes(values.dtype) if isinstance(values, types.Array) and isinstance(start, types.Integer) else None


@register(operations.load, loaded, [(types.Array, types.Integer)])
def _load(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    values = context.make_array(sig.args[0])(context, builder, value=args[0])
    place = builder.gep(values.data, [context.cast(builder, args[1], sig.args[1], types.intp)])
    lanes = context.get_value_type(sig.return_type)
    return builder.load(builder.bitcast(place, lanes.as_pointer()), align=sig.return_type.number.bitwidth // 8)


def gathered(values: types.Type, places: types.Type) -> types.Type | None:
    """Lanes of what an array holds."""
    return places if isinstance(values, types.Array) and isinstance(places, Lanes) else None


@register(operations.gather, gathered, [(types.Array, Lanes)])
def _gather(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    values = context.make_array(sig.args[0])(context, builder, value=args[0])
    lanes = sig.return_type
    held = ir.VectorType(context.get_value_type(sig.args[0].dtype), lanes.count)
    words = builder.fptosi(args[1], ir.VectorType(ir.IntType(64), lanes.count))
    got = ir.Constant(held, ir.Undefined)
    for i in range(lanes.count):
        lane = ir.Constant(ir.IntType(32), i)
        number = builder.load(builder.gep(values.data, [builder.extract_element(words, lane)]))
        got = builder.insert_element(got, number, lane)
    target = context.get_value_type(lanes)
    if held == target:
        return got
    return (
        builder.fpext(got, target)
        if sig.args[0].dtype.bitwidth < lanes.number.bitwidth
        else builder.fptrunc(got, target)
    )


def saved(x: types.Type, values: types.Type, start: types.Type) -> types.Type | None:
    """Nothing, for lanes and an array of such numbers."""
    return types.none if isinstance(values, types.Array) and x == Lanes(values.dtype) else None


@register(operations.save, saved, [(Lanes, types.Array, types.Integer)])
def _save(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    values = context.make_array(sig.args[1])(context, builder, value=args[1])
    place = builder.gep(values.data, [context.cast(builder, args[2], sig.args[2], types.intp)])
    builder.store(args[0], builder.bitcast(place, args[0].type.as_pointer()), align=sig.args[0].number.bitwidth // 8)
    return context.get_dummy_value()
