"""SIMD operations, compiled, on single numbers, lanes and Vecs: one LLVM instruction or a few."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

from llvmlite import ir
from llvmlite.binding import get_host_cpu_features
from numba import types
from numba.core import cgutils, config

from minirt import lanes
from minirt.lanes.compiled.types import (
    ANY,
    Lanes,
    Mask,
    VecType,
    common,
    constant,
    is_number,
    llvm,
    one_number,
    register,
    same_numbers,
    single,
    two_numbers,
    vec_of,
    vec_parts,
    widen,
)

# By the size of a number in bits: the bits of its fraction, and what is added to its exponent before it is stored.
FRACTION_BITS = {64: 52, 32: 23}
BIAS = {64: 1023, 32: 127}
ROUNDOFF = {64: 2.0**-53, 32: 2.0**-24}  # unit roundoff
# 1 / sqrt(x). Normalising a vector takes a square root and a division, and both wait for the one divider of a processor
# core. AVX-512 also has an instruction that estimates 1 / sqrt(x) to 14 bits (rsqrt14). With e = 1 - x y^2 for the
# estimate y, the result is y / sqrt(1 - e): its binomial series y (1 + e/2 + 3/8 e^2 + 5/16 e^3 + ...) is summed until
# the error is within 2 units in the last place.
SERIES = {"double": (5 / 16, 3 / 8, 1 / 2), "float": (3 / 8, 1 / 2)}  # coefficients of e, the highest power first


@cache
def has_estimate() -> bool:
    """Whether the processor that is compiled for has AVX-512: as NUMBA_CPU_FEATURES says, or the one at hand."""
    if config.CPU_FEATURES is not None:
        return "+avx512f" in config.CPU_FEATURES.split(",")
    try:
        return bool(config.ENABLE_AVX and get_host_cpu_features().get("avx512f"))
    except RuntimeError:  # LLVM does not know the features of this processor
        return False


def inverse_root(context: Any, builder: ir.IRBuilder, x: Any) -> Any:
    """Return 1 / sqrt(x) for positive normal numbers x."""
    if not isinstance(x.type, ir.VectorType) or not has_estimate():
        return builder.fdiv(constant(x, 1.0), llvm(builder, "sqrt", x))
    y = estimate(builder, x)
    error = llvm(builder, "fma", builder.fneg(x), builder.fmul(y, y), constant(x, 1.0))
    first, *rest = SERIES[str(x.type.element)]
    total = constant(x, first)
    for coefficient in rest:
        total = llvm(builder, "fma", total, error, constant(x, coefficient))
    return llvm(builder, "fma", builder.fmul(y, error), total, y)


def estimate(builder: ir.IRBuilder, x: Any) -> Any:
    """Return 1 / sqrt(x) with a relative error below 2^-14, one register after the other."""
    number = x.type.element
    double = number == ir.DoubleType()
    lanes = 8 if double else 16
    register, bits = ir.VectorType(number, lanes), ir.IntType(lanes)
    function = cgutils.get_or_insert_function(
        builder.module,
        ir.FunctionType(register, [register, register, bits]),
        f"llvm.x86.avx512.rsqrt14.{'pd' if double else 'ps'}.512",
    )
    parts = [pick(builder, x, range(start, start + lanes)) for start in range(0, x.type.count, lanes)]
    results = [builder.call(function, [part, part, ir.Constant(bits, -1)]) for part in parts]
    while len(results) > 1:
        results = [join(builder, *pair) for pair in zip(results[::2], results[1::2], strict=True)]
    return results[0]


def pick(builder: ir.IRBuilder, x: Any, lanes: range) -> Any:
    """Return some lanes of a vector."""
    return builder.shuffle_vector(x, x, lane_indices(lanes))


def join(builder: ir.IRBuilder, a: Any, b: Any) -> Any:
    """Return the lanes of a and after them the lanes of b."""
    return builder.shuffle_vector(a, b, lane_indices(range(2 * a.type.count)))


def lane_indices(lanes: range) -> ir.Constant:
    """Return the indices of lanes as an LLVM vector, for a shuffle."""
    return ir.Constant(ir.VectorType(ir.IntType(32), len(lanes)), list(lanes))


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


register_intrinsic(lanes.sqrt, "sqrt", 1)
register_intrinsic(lanes.fabs, "fabs", 1)
register_intrinsic(lanes.floor, "floor", 1)
register_intrinsic(lanes.copysign, "copysign", 2)
register_selection(lanes.minimum, "<")
register_selection(lanes.maximum, ">")


@register(lanes.inverse_root, one_number, [(ANY,)])
def _inverse_root(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return inverse_root(context, builder, *same_numbers(context, builder, sig, args))


def where_type(mask: types.Type, a: types.Type, b: types.Type) -> types.Type | None:
    """Return the type of `where`: lanes if one of its arguments has lanes."""
    if isinstance(a, VecType) and isinstance(b, VecType):
        return VecType(where_type(mask, a.number, b.number))
    if is_number(a) and is_number(b):
        return mask.lanes if isinstance(mask, Mask) else common(a, b)
    return None


@register(lanes.where, where_type, [(ANY, ANY, ANY)])
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


@register(lanes.width, lambda x: types.int64 if isinstance(x, (Lanes, types.Array)) else None, [(ANY,)])
def _width(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    kind = sig.args[0]
    return context.get_constant(types.int64, (Lanes(kind.dtype) if isinstance(kind, types.Array) else kind).count)


@register(
    lanes.lane,
    lambda x, ray: x.number if isinstance(x, Lanes) and isinstance(ray, types.Integer) else None,
    [(Lanes, types.Integer)],
)
def _lane(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return builder.extract_element(args[0], context.cast(builder, args[1], sig.args[1], types.int32))


def second_type(x: types.Type, like: types.Type) -> types.Type | None:
    """Return the type of the second argument: lanes, or a single number."""
    return like if is_number(x) and isinstance(like, (Lanes, types.Float)) else None


@register(lanes.splat, second_type, [(ANY, ANY)])
def _splat(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return widen(context, builder, args[0], sig.args[0], sig.return_type)


def integer_layout(number: types.Float, like: Any) -> tuple[ir.Type, int, int]:
    """Return the LLVM type of the bits of `like`, of numbers of a type, and their count of fraction bits and bias."""
    integer = ir.IntType(number.bitwidth)
    is_vector = isinstance(like.type, ir.VectorType)
    kind = ir.VectorType(integer, like.type.count) if is_vector else integer
    return kind, FRACTION_BITS[number.bitwidth], BIAS[number.bitwidth]


@register(lanes.exponent, one_number, [(ANY,)])
def _exponent(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    (x,) = same_numbers(context, builder, sig, args)
    integers, fraction, bias = integer_layout(single(sig.return_type), x)
    stored = builder.bitcast(x, integers)
    stored = builder.lshr(stored, constant(stored, fraction))
    return builder.sitofp(builder.sub(stored, constant(stored, bias)), x.type)


@register(lanes.two_to, one_number, [(ANY,)])
def _two_to(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    (x,) = same_numbers(context, builder, sig, args)
    integers, fraction, bias = integer_layout(single(sig.return_type), x)
    bounded = llvm(builder, "maxnum", x, constant(x, float(-bias)))
    whole = builder.fptosi(bounded, integers)
    stored = builder.shl(builder.add(whole, constant(whole, bias)), constant(whole, fraction))
    return builder.bitcast(stored, x.type)


@register(lanes.unit_roundoff, single, [(ANY,)])
def _unit_roundoff(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    return context.get_constant(sig.return_type, ROUNDOFF[sig.return_type.bitwidth])


@register(lanes.rounded_product, two_numbers, [(ANY, ANY)])
def _rounded_product(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    # Without the fence the flags of the kernel allow fusing the product with a sum that follows.
    return llvm(builder, "arithmetic.fence", builder.fmul(*same_numbers(context, builder, sig, args)))


@register(lanes.product_error, two_numbers, [(ANY, ANY)])
def _product_error(context: Any, builder: ir.IRBuilder, sig: Any, args: Any) -> Any:
    a, b = same_numbers(context, builder, sig, args)
    return llvm(builder, "fma", a, b, builder.fneg(builder.fmul(a, b)))
